// SPDX-License-Identifier: BSD-3-Clause
// A value on the heap whose copies share it until one of them is edited.
#pragma once

#include <atomic>
#include <utility>

namespace waymark {

/// Empty, or a handle to a value that other handles may share. Copying costs a counter increment;
/// edit() first gives this handle a value of its own. Different handles may be used by different
/// threads, even when they share a value. (std::shared_ptr::use_count does not order memory, so it
/// cannot be used to decide whether a value is shared.)
template <class Value>
class CopyOnWrite {
 public:
  CopyOnWrite() = default;

  CopyOnWrite(const CopyOnWrite& other) noexcept : shared_{other.shared_} {
    if (shared_) shared_->users.fetch_add(1, std::memory_order_relaxed);
  }

  CopyOnWrite(CopyOnWrite&& other) noexcept : shared_{std::exchange(other.shared_, nullptr)} {}

  CopyOnWrite& operator=(CopyOnWrite other) noexcept {
    std::swap(shared_, other.shared_);
    return *this;
  }

  ~CopyOnWrite() {
    if (shared_ && shared_->users.fetch_sub(1, std::memory_order_acq_rel) == 1) delete shared_;
  }

  /// Null when empty. Two handles share when the addresses are equal.
  const Value* get() const { return shared_ ? &shared_->value : nullptr; }

  bool is_private() const { return shared_ && shared_->users.load(std::memory_order_acquire) == 1; }

  /// The value, unshared; default-constructed when there was none.
  Value& edit() {
    if (!is_private()) {
      CopyOnWrite own;
      own.shared_ = shared_ ? new Counted{shared_->value} : new Counted{};
      std::swap(shared_, own.shared_);
    }
    return shared_->value;
  }

 private:
  struct Counted {
    Counted() = default;

    explicit Counted(const Value& copied) : value{copied} {}

    Value value{};
    std::atomic<int> users{1};
  };

  Counted* shared_{nullptr};
};

}  // namespace waymark
