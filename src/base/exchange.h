#pragma once
// Lock-free hand-over between threads: a latest-value slot (one writer, one reader) and a bounded queue (one writer, one
// reader). Neither allocates after construction, neither blocks.

#include <array>
#include <atomic>
#include <cstddef>
#include <vector>

namespace filum {

/// Triple buffer: the reader always sees the newest complete value; older ones are overwritten.
/// One writer thread, one reader thread. T must copy-assign without allocating once both sides have the same size.
template <class T>
class Latest {
 public:
  explicit Latest(const T& initial = T()) : slots_{initial, initial, initial} {}

  /// Writer: the slot to fill, then publish().
  T& write_slot() noexcept { return slots_[static_cast<std::size_t>(write_)]; }
  void publish() noexcept { write_ = middle_.exchange(write_ | kFresh, std::memory_order_acq_rel) & kIndex; }

  /// Reader: true if something newer than the last read() is there now.
  bool fresh() const noexcept { return (middle_.load(std::memory_order_acquire) & kFresh) != 0; }
  /// Reader: the newest value; stays valid until the next read().
  const T& read() noexcept {
    if (fresh()) read_ = middle_.exchange(read_, std::memory_order_acq_rel) & kIndex;
    return slots_[static_cast<std::size_t>(read_)];
  }

 private:
  static constexpr int kFresh = 4;
  static constexpr int kIndex = 3;
  std::array<T, 3> slots_;
  int write_ = 0;
  std::atomic<int> middle_{1};
  int read_ = 2;
};

/// Bounded single-producer single-consumer queue. push() fails (returns false) when full: the caller counts the loss.
template <class T>
class Queue {
 public:
  explicit Queue(std::size_t capacity, const T& initial = T()) : items_(capacity + 1, initial) {}

  bool push(const T& item) noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    const std::size_t next = (tail + 1) % items_.size();
    if (next == head_.load(std::memory_order_acquire)) return false;
    items_[tail] = item;
    tail_.store(next, std::memory_order_release);
    return true;
  }
  bool pop(T& item) noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head == tail_.load(std::memory_order_acquire)) return false;
    item = items_[head];
    head_.store((head + 1) % items_.size(), std::memory_order_release);
    return true;
  }

 private:
  std::vector<T> items_;
  std::atomic<std::size_t> head_{0};
  std::atomic<std::size_t> tail_{0};
};

}  // namespace filum
