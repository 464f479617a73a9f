// A solid as a row of 64-bit words, for checkpoints. One list of fields serves writing and reading.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "physics/rigid_body.hpp"

namespace mappm {

/// Calls visit for each field of fixed size; S is Solid<D> or const Solid<D>.
template <class S, class Visit>
void visit_fields(S& solid, Visit&& visit) {
  visit(solid.id);
  visit(solid.shape);
  visit(solid.group);
  visit(solid.motion);
  visit(solid.x);
  visit(solid.momentum);
  visit(solid.angular_momentum);
  visit(solid.orientation.component);
  visit(solid.fluid_impulse);
  visit(solid.sampled_impulse);
}

/// The same for a contact; C is Contact<D> or const Contact<D>.
template <class C, class Visit>
void visit_contact_fields(C& contact, Visit&& visit) {
  visit(contact.partner);
  visit(contact.own);
  visit(contact.other);
  visit(contact.stretch);
}

/// Appends fields to a row of words: integers as they are, 128-bit integers as two words (low, high), doubles by their
/// bits.
class WordWriter {
 public:
  explicit WordWriter(std::vector<std::uint64_t>& to) : to_(to) {}
  void operator()(std::uint64_t value) { to_.push_back(value); }
  void operator()(std::uint32_t value) { to_.push_back(value); }
  void operator()(SolidMotion value) { to_.push_back(static_cast<std::uint64_t>(value)); }
  void operator()(double value) { to_.push_back(std::bit_cast<std::uint64_t>(value)); }
  void operator()(Int128 value) {
    to_.push_back(static_cast<std::uint64_t>(value));
    to_.push_back(static_cast<std::uint64_t>(value >> 64));
  }
  template <int N, class T>
  void operator()(const Vec<N, T>& value) {
    for (const T& component : value.component) (*this)(component);
  }

 private:
  std::vector<std::uint64_t>& to_;
};

/// Takes fields from a row of words, in the order in which they were written.
class WordReader {
 public:
  explicit WordReader(const std::uint64_t* from) : from_(from) {}
  void operator()(std::uint64_t& value) { value = *from_++; }
  void operator()(std::uint32_t& value) { value = static_cast<std::uint32_t>(*from_++); }
  void operator()(SolidMotion& value) { value = static_cast<SolidMotion>(*from_++); }
  void operator()(double& value) { value = std::bit_cast<double>(*from_++); }
  void operator()(Int128& value) {
    const std::uint64_t low = *from_++;
    value = static_cast<Int128>(static_cast<std::int64_t>(*from_++)) << 64 | low;
  }
  template <int N, class T>
  void operator()(Vec<N, T>& value) {
    for (T& component : value.component) (*this)(component);
  }

 private:
  const std::uint64_t* from_;
};

/// Words of the fixed-size part, and the number of its contacts, whose values follow elsewhere.
template <int D>
void append_words(const Solid<D>& solid, std::vector<std::uint64_t>& to) {
  WordWriter writer(to);
  visit_fields(solid, writer);
  writer(static_cast<std::uint64_t>(solid.contacts.size()));
}

/// The solid of such a row; `contacts` get their number, not their values.
template <int D>
Solid<D> solid_of_words(const std::uint64_t* words) {
  Solid<D> solid;
  WordReader reader(words);
  visit_fields(solid, reader);
  std::uint64_t contacts = 0;
  reader(contacts);
  solid.contacts.resize(contacts);
  return solid;
}

/// Place of the shape in such a row: a reader looks at it before it trusts the sizes.
inline constexpr std::size_t solid_shape_word = 1;

/// Lengths of the rows.
template <int D>
std::size_t solid_word_count() {
  std::vector<std::uint64_t> words;
  append_words(Solid<D>{}, words);
  return words.size();
}
template <int D>
std::size_t contact_word_count() {
  std::vector<std::uint64_t> words;
  const Contact<D> contact;
  visit_contact_fields(contact, WordWriter(words));
  return words.size();
}

}  // namespace mappm
