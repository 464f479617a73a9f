// A digest of the whole integer state. Each particle's words are hashed together with its id, and the hashes are
// added modulo 2^64, so that the digest depends neither on the order nor on the owner of the particles.
#pragma once

#include <bit>
#include <cstdint>

#include "base/fixed_point.hpp"

namespace mappm {

/// Hash of a sequence of words (the finaliser of splitmix64, Steele, Lea and Flood 2014, chained).
class ParticleHash {
 public:
  explicit ParticleHash(std::uint64_t id) { add(id); }

  ParticleHash& add(std::uint64_t word) {
    state_ = mix(state_ ^ mix(word + 0x9e3779b97f4a7c15u));
    return *this;
  }
  ParticleHash& add(double value) { return add(std::bit_cast<std::uint64_t>(value + 0.0)); }  // -0 counts as 0
  ParticleHash& add(Int128 value) {
    return add(static_cast<std::uint64_t>(value)).add(static_cast<std::uint64_t>(value >> 64));
  }
  std::uint64_t value() const { return state_; }

 private:
  static constexpr std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  std::uint64_t state_ = 0x6d6170706d000001u;
};

}  // namespace mappm
