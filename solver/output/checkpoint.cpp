#include "output/checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "base/error.hpp"
#include "base/numerics_version.hpp"
#include "output/file_seal.hpp"
#include "output/hdf5_file.hpp"
#include "output/scene_identity.hpp"
#include "output/solid_words.hpp"
#include "output/together.hpp"
#include "output/totals.hpp"

namespace mappm {

namespace {

constexpr const char* format_name = "MaPPM checkpoint";
constexpr std::uint64_t format_version = 4;
constexpr std::uint64_t slice_rows = 1 << 18;        // PPs read at a time
constexpr std::uint64_t solid_slice_rows = 1 << 10;  // solids read at a time

/// Names of the PP fields, and the quantum that their counts are of.
template <int D>
std::string field_name(int field) {
  return std::string("/fluid/") + (field < D ? "x_" : "v_") + "xyz"[field % D];
}
template <int D>
double field_quantum(int field) {
  return field < D ? 1.0 : velocity_quantum;
}

template <class Values>
std::vector<std::int64_t> counts(const Values& values, double quantum) {
  std::vector<std::int64_t> result(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) result[i] = static_cast<std::int64_t>(values[i] / quantum);
  return result;
}

template <int N>
std::vector<std::uint64_t> words_of(const Vec<N, Int128>& value) {
  std::vector<std::uint64_t> words;
  WordWriter writer(words);
  writer(value);
  return words;
}

/// Share of a hash over what the digest of the state leaves out: the rows of the solids, the ledger, the steps.
template <int D>
std::uint64_t ledger_hash_share(const State<D>& state, const Vec<D, Int128>& outside_impulse,
                                std::uint64_t sampled_step, bool is_first) {
  std::uint64_t sum = 0;
  std::vector<std::uint64_t> words;
  const auto add = [&](std::uint64_t id) {
    ParticleHash hash(id);
    for (const std::uint64_t word : words) hash.add(word);
    sum += hash.value();
    words.clear();
  };
  for (const Solid<D>& solid : state.solids) {
    append_words(solid, words);
    add(solid.id);
  }
  if (!is_first) return sum;
  WordWriter writer(words);
  writer(state.start_momentum);
  writer(outside_impulse);
  writer(state.step);
  writer(sampled_step);
  add(~std::uint64_t{0});
  return sum;
}

/// Sums over the group: digest of the state, hash of the ledger.
template <int D>
std::array<std::uint64_t, 2> hashes(const State<D>& state, const Vec<D, Int128>& outside_impulse,
                                    std::uint64_t sampled_step, const Group& group) {
  std::array<std::uint64_t, 2> sums{digest_share(state),
                                    ledger_hash_share(state, outside_impulse, sampled_step, group.is_first())};
  group.sum(std::span<std::uint64_t>(sums));
  return sums;
}

template <int D>
void write_solids(const std::vector<Solid<D>>& solids, Hdf5Writer& file) {
  std::vector<std::uint64_t> words, contacts;
  for (const Solid<D>& solid : solids) {
    append_words(solid, words);
    for (const Contact<D>& contact : solid.contacts) visit_contact_fields(contact, WordWriter(contacts));
  }
  file.make_group("/solids");
  file.rows("/solids/words", words, solid_word_count<D>());
  file.rows("/solids/contacts", contacts, contact_word_count<D>());
}

[[noreturn]] void refuse(const std::string& path, const std::string& why) { throw InputError(path + ": " + why); }

void check_header(const Hdf5Reader& file, const std::string& path, const std::string& scene_text) {
  if (file.text_attribute("/", "format") != format_name) refuse(path, "is no checkpoint of this program");
  const std::uint64_t version = file.number_attribute("/", "version");
  if (version != format_version)
    refuse(path, "has version " + std::to_string(version) + " of the checkpoint format, this program reads version " +
                     std::to_string(format_version) + "; resume with the program that wrote it");
  if (const std::uint64_t numerics = file.number_attribute("/", "numerics"); numerics != numerics_version)
    refuse(path, fmt::format("was computed by numerics version {}, this program has {}: going on would give neither's "
                             "results; resume with the program that wrote it, or start anew",
                             numerics, numerics_version));
  const auto letters = file.rows<std::uint8_t>("/scene", 0, file.row_count("/scene"), 0);
  const std::string text(letters.begin(), letters.end());
  if (file.number_attribute("/", "scene_hash") != text_hash(text)) refuse(path, "is damaged: its scene");
  const std::string difference = first_difference(scene_text, text);
  if (!difference.empty())
    refuse(path, "belongs to another scene: " + difference +
                     "; only [output] and run.steps or run.duration may differ when a run is resumed");
}

template <int D>
void read_fluid(const Hdf5Reader& file, const Region<D>& region, FluidParticles<D>& fluid) {
  const std::uint64_t all = file.row_count("/fluid/id");
  constexpr int fields = FluidParticles<D>::field_count;
  for (std::uint64_t first = 0; first < all; first += slice_rows) {
    const std::uint64_t count = std::min(slice_rows, all - first);
    const std::vector<std::uint64_t> ids = file.rows<std::uint64_t>("/fluid/id", first, count, 0);
    std::array<std::vector<std::int64_t>, fields> slice;
    for (int field = 0; field < fields; ++field)
      slice[field] = file.rows<std::int64_t>(field_name<D>(field), first, count, 0);
    for (std::uint64_t i = 0; i < count; ++i) {
      Vec<D, double> x;
      for (int axis = 0; axis < D; ++axis) x[axis] = static_cast<double>(slice[axis][i]);
      if (!region.contains(x)) continue;
      fluid.id.push_back(ids[i]);
      for (int field = 0; field < fields; ++field)
        fluid.field[field].push_back(static_cast<double>(slice[field][i]) * field_quantum<D>(field));
    }
  }
}

/// Sizes in a row of words are trusted only as far as the model agrees.
template <int D>
Solid<D> checked_solid(const std::uint64_t* words, const Model<D>& model, const std::string& path) {
  if (words[solid_shape_word] >= model.shapes.size()) refuse(path, "is damaged: its solids have other shapes");
  return solid_of_words<D>(words);
}

template <int D>
void read_solids(const Hdf5Reader& file, const std::string& path, const Model<D>& model, const Region<D>& region,
                 std::vector<Solid<D>>& solids) {
  const std::size_t width = solid_word_count<D>(), contact_width = contact_word_count<D>();
  const std::uint64_t all = file.row_count("/solids/words");
  const std::uint64_t all_contacts = file.row_count("/solids/contacts");
  std::uint64_t next_contact = 0;
  for (std::uint64_t first = 0; first < all; first += solid_slice_rows) {
    const std::uint64_t count = std::min(solid_slice_rows, all - first);
    const std::vector<std::uint64_t> words = file.rows<std::uint64_t>("/solids/words", first, count, width);
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint64_t contacts = words[(i + 1) * width - 1];
      if (contacts > all_contacts) refuse(path, "is damaged");
      Solid<D> solid = checked_solid<D>(&words[i * width], model, path);
      if (region.contains(solid.x)) {
        const auto rows = file.rows<std::uint64_t>("/solids/contacts", next_contact, contacts, contact_width);
        for (std::size_t k = 0; k < contacts; ++k)
          visit_contact_fields(solid.contacts[k], WordReader(&rows[k * contact_width]));
        solids.push_back(std::move(solid));
      }
      next_contact += contacts;
    }
  }
  std::sort(solids.begin(), solids.end(), [](const Solid<D>& a, const Solid<D>& b) { return a.id < b.id; });
}

}  // namespace

template <int D>
std::uint64_t checkpoint_bytes(std::uint64_t fluid_particles, std::uint64_t solids) {
  const std::uint64_t words = fluid_particles * (1 + FluidParticles<D>::field_count) + solids * solid_word_count<D>();
  return words * sizeof(std::uint64_t);
}

template <int D>
void write_checkpoint(const std::string& path, const std::string& scene_text, const State<D>& state,
                      std::uint64_t sampled_step, const Group& group) {
  Vec<D, Int128> outside_impulse = state.outside_impulse;
  group.sum(std::span<Int128>(outside_impulse.component));
  const auto [digest, ledger] = hashes(state, outside_impulse, sampled_step, group);
  const auto number = [](std::uint64_t value) { return std::vector<std::uint64_t>{value}; };

  Hdf5Writer file(path, group);
  file.text_attribute("/", "format", format_name);
  file.attribute("/", "version", number(format_version));
  file.attribute("/", "numerics", number(numerics_version));
  file.attribute("/", "dimension", number(D));
  file.rows(
      "/scene",
      group.is_first() ? std::vector<std::uint8_t>(scene_text.begin(), scene_text.end()) : std::vector<std::uint8_t>{},
      0);
  file.attribute("/", "scene_hash", number(text_hash(scene_text)));
  file.attribute("/", "step", number(state.step));
  file.attribute("/", "sampled_step", number(sampled_step));
  file.attribute("/", "digest", number(digest));
  file.attribute("/", "ledger_hash", number(ledger));
  file.attribute("/", "start_momentum", words_of(state.start_momentum));
  file.attribute("/", "outside_impulse", words_of(outside_impulse));
  file.make_group("/fluid");
  file.rows("/fluid/id", state.fluid.id, 0);
  for (int field = 0; field < FluidParticles<D>::field_count; ++field)
    file.rows(field_name<D>(field), counts(state.fluid.field[field], field_quantum<D>(field)), 0);
  write_solids(state.solids, file);
  file.close();
  seal_file(path, group);
}

template <int D>
Checkpoint<D> read_checkpoint(const std::string& path, const std::string& scene_text, const Model<D>& model,
                              const Region<D>& region, const Group& group) {
  Vec<D, Int128> outside_impulse;
  std::array<std::uint64_t, 2> stored{};
  check_seal(path, group);
  Checkpoint<D> checkpoint = together(group, [&] {
    const Hdf5Reader file(path);
    check_header(file, path, scene_text);
    Checkpoint<D> read;
    read.state.step = file.number_attribute("/", "step");
    read.sampled_step = file.number_attribute("/", "sampled_step");
    stored = {file.number_attribute("/", "digest"), file.number_attribute("/", "ledger_hash")};
    const auto ledger_words = [&](const std::string& name) {
      auto words = file.attribute<std::uint64_t>("/", name);
      if (words.size() != std::size_t{2 * D}) refuse(path, "is damaged: " + name);
      return words;
    };
    WordReader{ledger_words("start_momentum").data()}(read.state.start_momentum);
    WordReader{ledger_words("outside_impulse").data()}(outside_impulse);
    read_fluid(file, region, read.state.fluid);
    read_solids(file, path, model, region, read.state.solids);
    return read;
  });
  if (group.is_first()) checkpoint.state.outside_impulse = outside_impulse;
  if (hashes(checkpoint.state, outside_impulse, checkpoint.sampled_step, group) != stored)
    refuse(path, "is damaged: digest " + digest_text(stored[0]) + " was written, its content has another one");
  return checkpoint;
}

template std::uint64_t checkpoint_bytes<2>(std::uint64_t, std::uint64_t);
template std::uint64_t checkpoint_bytes<3>(std::uint64_t, std::uint64_t);
template void write_checkpoint<2>(const std::string&, const std::string&, const State<2>&, std::uint64_t, const Group&);
template void write_checkpoint<3>(const std::string&, const std::string&, const State<3>&, std::uint64_t, const Group&);
template Checkpoint<2> read_checkpoint<2>(const std::string&, const std::string&, const Model<2>&, const Region<2>&,
                                          const Group&);
template Checkpoint<3> read_checkpoint<3>(const std::string&, const std::string&, const Model<3>&, const Region<3>&,
                                          const Group&);

}  // namespace mappm
