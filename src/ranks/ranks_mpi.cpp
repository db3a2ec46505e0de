// Tasks are dealt out by one counter on rank 0 that every rank raises by MPI_Fetch_and_op (one-sided, MPI-3.1 sec. 11.3.4): long and short
// datasets mix without a master, and which rank computes what changes no report.

#include <mpi.h>

#include <mutex>
#include <stdexcept>

#include "ranks/ranks.h"

namespace filum {
namespace {

void check(int code, const char* what) {
  if (code != MPI_SUCCESS) throw std::runtime_error(std::string("MPI: ") + what + " failed");
}

class MpiRanks final : public Ranks {
 public:
  MpiRanks() {
    int provided = 0;
    check(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided), "MPI_Init_thread");
    if (provided < MPI_THREAD_SERIALIZED) throw std::runtime_error("MPI: this library serves one thread only");
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    check(MPI_Win_allocate(rank_ == 0 ? sizeof(long) : 0, sizeof(long), MPI_INFO_NULL, MPI_COMM_WORLD, &counter_, &window_), "MPI_Win_allocate");
    if (rank_ == 0) *counter_ = 0;
    MPI_Barrier(MPI_COMM_WORLD);
    MPI_Win_lock_all(0, window_);
  }
  ~MpiRanks() override {
    MPI_Win_unlock_all(window_);
    MPI_Win_free(&window_);
    MPI_Finalize();
  }
  int rank() const override { return rank_; }
  int size() const override { return size_; }

  std::string from_first(const std::string& text) override {
    const std::lock_guard lock(guard_);
    unsigned long long length = text.size();
    check(MPI_Bcast(&length, 1, MPI_UNSIGNED_LONG_LONG, 0, MPI_COMM_WORLD), "MPI_Bcast");
    std::string out = rank_ == 0 ? text : std::string(length, '\0');
    check(MPI_Bcast(out.data(), static_cast<int>(length), MPI_CHAR, 0, MPI_COMM_WORLD), "MPI_Bcast");
    return out;
  }

  long next() override {
    const std::lock_guard lock(guard_);
    const long one = 1;
    long before = 0;
    check(MPI_Fetch_and_op(&one, &before, MPI_LONG, 0, 0, MPI_SUM, window_), "MPI_Fetch_and_op");
    check(MPI_Win_flush(0, window_), "MPI_Win_flush");
    return before;
  }

  long sum(long value) override {
    const std::lock_guard lock(guard_);
    long all = 0;
    check(MPI_Allreduce(&value, &all, 1, MPI_LONG, MPI_SUM, MPI_COMM_WORLD), "MPI_Allreduce");
    return all;
  }

 private:
  int rank_ = 0, size_ = 1;
  long* counter_ = nullptr;
  MPI_Win window_ = MPI_WIN_NULL;
  std::mutex guard_;
};

}  // namespace
}  // namespace filum

extern "C" filum::Ranks* filum_start_ranks() { return new filum::MpiRanks; }
