#pragma once
// Several processes that share a list of tasks. The module behind this (MPI) is loaded only by `filum reconcile --all` under mpirun or
// srun; no other part of the program needs or sees it.

#include <string>

namespace filum {

class Ranks {
 public:
  virtual ~Ranks() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  /// The same text on every rank: that of rank 0.
  virtual std::string from_first(const std::string& text) = 0;
  /// The next number of a counter that all ranks share, from 0 on. Any thread may ask.
  virtual long next() = 0;
  /// Waits for all and sums a number over all ranks.
  virtual long sum(long value) = 0;
};

/// What the module filum_ranks.so exports: a new Ranks, MPI begun; deleting it ends MPI.
using StartRanks = Ranks* (*)();
inline constexpr const char* kStartRanks = "filum_start_ranks";

}  // namespace filum
