#include "library/simulation.hpp"

#include "base/error.hpp"
#include "base/single_group.hpp"
#include "output/totals.hpp"
#include "scene/build.hpp"
#include "scene/reader.hpp"
#include "serial/engine.hpp"

namespace mappm {

class Simulation::Engine {
 public:
  virtual ~Engine() = default;
  virtual void step() = 0;
  virtual std::uint64_t present_step() const = 0;
  virtual std::uint64_t particles() = 0;
  virtual std::string digest() = 0;
  virtual const std::vector<std::string>& warnings() const = 0;
};

namespace {

template <int D>
class EngineIn : public Simulation::Engine {
 public:
  explicit EngineIn(const Scene& scene)
      : built_(make_model<D>(scene)),
        engine_(built_.model, build_state<D>(scene, built_.model, Region<D>::whole_box()), Neighbours::cells) {}

  void step() override {
    engine_.step();
    if (engine_.first_fault().any()) throw RangeError(engine_.first_fault().text());
    if (!engine_.overlaps().last.text.empty()) throw RangeError(engine_.overlaps().last.text);
  }
  std::uint64_t present_step() const override { return engine_.present_step(); }
  std::uint64_t particles() override { return totals().particles(); }
  std::string digest() override { return digest_text(totals().digest()); }
  const std::vector<std::string>& warnings() const override { return built_.warnings; }

 private:
  Totals<D> totals() { return measure(built_.model, engine_.sample(), SingleGroup()); }

  BuiltModel<D> built_;
  SerialEngine<D> engine_;
};

std::unique_ptr<Simulation::Engine> engine_of(const Scene& scene) {
  if (scene.dimension == 2) return std::make_unique<EngineIn<2>>(scene);
  return std::make_unique<EngineIn<3>>(scene);
}

}  // namespace

Simulation::Simulation(const std::string& scene, const std::vector<std::string>& overrides)
    : engine_(engine_of(read_scene(scene, overrides))) {}

Simulation::~Simulation() = default;

void Simulation::step() { engine_->step(); }
std::uint64_t Simulation::present_step() const { return engine_->present_step(); }
std::uint64_t Simulation::particles() { return engine_->particles(); }
std::string Simulation::digest() { return engine_->digest(); }
const std::vector<std::string>& Simulation::warnings() const { return engine_->warnings(); }

}  // namespace mappm
