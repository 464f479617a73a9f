// The two message pairs per neighbour and step.
//   1. `exchange`: every particle and solid goes to each region in whose margin it lies now. Whether the receiver owns
//      it (a migrant) or holds it as a ghost or copy follows from its position alone, so migration and halo are one
//      message: the paper's steps (i)-(iv) and (x)-(xi). PPs whose images the process needs itself are no message. It
//      begins with the step in which the sender's stay will end (residents.hpp).
//   2. densities: those of PPs and FPs in this region go wherever they are ghosts.
//   3. `send_home`: what FPs of copies received from the PPs of this region goes to the owner of the solid: the paper's
//      steps (vii) and (viii).
#pragma once

#include <span>
#include <vector>

#include "parallel/communicator.hpp"
#include "parallel/domains.hpp"
#include "parallel/message.hpp"
#include "parallel/phase_times.hpp"
#include "parallel/placed_solids.hpp"
#include "parallel/residents.hpp"
#include "particles/engine.hpp"
#include "particles/solid_step.hpp"

namespace mappm {

/// What one process found out about a copy of a solid: the load of the FPs in its region.
template <int D>
struct HomeReport {
  std::uint64_t solid = 0;  // id
  SolidImpulse<D> fluid;
  bool any = false;  // such FPs
};

template <int D>
class Halo {
 public:
  Halo(const Model<D>& model, const Domains<D>& domains, const Communicator& communicator);

  const Region<D>& region() const { return region_; }
  /// The region and its margin of rcut: where FPs matter.
  const Region<D>& reach() const { return reach_; }
  /// Where PPs lie that are needed elsewhere: a region for each image of a neighbour.
  const std::vector<NeededRegion<D>>& needed() const { return needed_; }

  /// On entry `state` holds what this process owned before the particles moved, at their new positions, and the PPs of
  /// a stay. On return it holds its particles and, as far out as rcut + skin, ghosts, all in its frame, and its solids;
  /// `copies` holds copies of solids. True if the stay of the PPs goes on, in which a ghost that has left that margin
  /// may be an old one; otherwise it has ended, and they are in any order. The message itself counts as one of PPs.
  bool exchange(State<D>& state, Residents<D>& residents, std::vector<Solid<D>>& copies, PhaseTimes& times) {
    begin_exchange(state, residents, times);
    return end_exchange(state, residents, copies, times);
  }
  /// The same in two parts. Between them the messages are on their way, and a stay that lasts may still end.
  void begin_exchange(State<D>& state, Residents<D>& residents, PhaseTimes& times);
  bool end_exchange(State<D>& state, Residents<D>& residents, std::vector<Solid<D>>& copies, PhaseTimes& times);

  /// In a step, after `settle` where the PPs have not stayed: densities of what lies in this region go to those who
  /// have ghosts of it: density[i] of PP i, and of the FPs.
  void begin_densities(const FluidParticles<D>& fluid, const Residents<D>& residents, std::span<double> density,
                       const PlacedSolids<D>& solids);
  /// Those of ghosts, from others.
  void end_densities(Residents<D>& residents, std::span<double> density, PlacedSolids<D>& solids);

  /// Delivers reports to the owners of the solids; returns those for solids owned here.
  std::vector<HomeReport<D>> send_home(const std::vector<Solid<D>>& copies, std::vector<HomeReport<D>>&& reports);

  const Traffic& traffic() const { return traffic_; }

 private:
  Vec<D, double> in_frame(Vec<D, double> x) const;
  void choose(FluidParticles<D>& fluid, bool own_images_alone);
  void pack_fluid(FluidParticles<D>& fluid, const Residents<D>& residents);
  void add_own_images(FluidParticles<D>& fluid) const;
  void pack_solids(std::vector<Solid<D>>& solids);
  void pack_solid(const Solid<D>& solid, std::size_t image);
  void unpack_fluid(BufferReader& reader, FluidParticles<D>& fluid);
  void unpack_solids(std::vector<BufferReader>& readers, std::vector<Solid<D>>& solids,
                     std::vector<Solid<D>>& copies) const;
  template <class Visit>
  void for_each_image_of(std::size_t partner, Visit&& visit) const {
    for (std::size_t n = 0; n < images_.size(); ++n)
      if (images_[n].partner == static_cast<int>(partner)) visit(n);
  }
  void put_frozen_densities(const PlacedSolids<D>& solids);
  void take_frozen_densities(std::vector<BufferReader>& readers, PlacedSolids<D>& solids) const;
  void send_messages();
  void receive_messages();

  const Model<D>& model_;
  const Domains<D>& domains_;
  const Communicator& communicator_;
  Region<D> region_, reach_, solid_reach_;
  Region<D> interior_, solid_interior_;  // particles and solids here are needed by nobody else
  std::vector<Image<D>> images_;
  std::vector<NeededRegion<D>> needed_;  // around each image, a margin of rcut + skin
  std::vector<Region<D>> image_reach_, image_solid_reach_;
  std::vector<int> partners_;
  std::vector<Buffer> out_, in_;
  std::vector<std::vector<std::uint32_t>> selected_;  // PPs chosen for each image
  Traffic traffic_;
};

}  // namespace mappm
