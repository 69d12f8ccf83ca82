// SPDX-License-Identifier: Apache-2.0
// Typed indices and the arrays they index.
#pragma once
#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

namespace bw {

/// A 32-bit index that can't be mistaken for another kind: made explicitly, read as int. -1 is "none".
template <class Tag>
struct Id {
  int32_t value = -1;
  constexpr Id() = default;
  constexpr explicit Id(int64_t v) : value(int32_t(v)) {}
  constexpr operator int32_t() const { return value; }
  constexpr bool valid() const { return value >= 0; }
};
using NodeId = Id<struct NodeTag>;
using ElemId = Id<struct ElemTag>;

/// Cache-line aligned storage, so that packs load in one piece, with a line to spare behind: a load that begins at the last
/// entry may reach beyond it.
template <class T>
struct AlignedAllocator {
  using value_type = T;
  AlignedAllocator() = default;
  template <class U> AlignedAllocator(const AlignedAllocator<U>&) {}
  T* allocate(size_t n) { return static_cast<T*>(::operator new(n * sizeof(T) + 64, std::align_val_t(64))); }
  void deallocate(T* p, size_t) { ::operator delete(p, std::align_val_t(64)); }
  friend bool operator==(AlignedAllocator, AlignedAllocator) { return true; }
};
template <class T> using Aligned = std::vector<T, AlignedAllocator<T>>;

/// One value per Index (NodeId, ElemId ...), aligned.
template <class T, class Index>
class Field {
 public:
  Field() = default;
  explicit Field(size_t n, T value = {}) : data_(n, value) {}
  T& operator[](Index i) { return data_[size_t(i.value)]; }
  const T& operator[](Index i) const { return data_[size_t(i.value)]; }
  size_t size() const { return data_.size(); }
  void resize(size_t n, T value = {}) { data_.resize(n, value); }
  void push_back(T value) { data_.push_back(value); }
  T* data() { return data_.data(); }
  const T* data() const { return data_.data(); }
  auto begin() { return data_.begin(); }
  auto end() { return data_.end(); }
  auto begin() const { return data_.begin(); }
  auto end() const { return data_.end(); }

 private:
  Aligned<T> data_;
};

}  // namespace bw
