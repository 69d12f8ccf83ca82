// SPDX-License-Identifier: Apache-2.0
// What modules keep in a checkpoint. Each has one member `template <class A> void keep(A& archive)` that names its
// state, and serves to save it and to restore it. Arrays of elements are held by their owners only: they are written
// with their numbers, so that another number of ranks finds its own.
#pragma once
#include <algorithm>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "common/io/checkpoint.h"
#include "csd/element/elements.h"

namespace bw::csd {

class Archive {
  template <class T>
  using Plain = std::conditional_t<std::is_same_v<T, bool>, uint8_t, T>;
  template <class C>
  using Item = std::remove_cvref_t<decltype(*std::declval<C&>().begin())>;

 public:
  /// To save, or to restore into a model that has the saved one's connectivity.
  Archive(const Saved& to, const Mesh& mesh, const Elements& elements);
  Archive(const Restored& from, const Mesh& mesh, const Elements& elements);

  bool restores() const { return from_.has_value(); }
  Archive section(const std::string& name) const;

  // --- the same on all ranks
  template <class T>
  void value(const std::string& name, T& v) {
    std::vector<Plain<T>> one{Plain<T>(v)};
    list(name, one);
    if (restores()) v = T(one.at(0));
  }
  /// A vector, an Aligned or a Field of any length.
  template <class C>
  void list(const std::string& name, C& container) {
    using T = Item<C>;
    if (to_) to_->same(name, std::vector<T>(container.begin(), container.end()));
    if (!from_) return;
    const std::vector<T> all = from_->same<T>(name);
    container.resize(all.size());
    std::copy(all.begin(), all.end(), container.begin());
  }
  template <class T>
  void lists(const std::string& name, std::vector<std::vector<T>>& a) {
    std::vector<int64_t> lengths;
    std::vector<T> all;
    for (const auto& one : a) lengths.push_back(int64_t(one.size())), all.insert(all.end(), one.begin(), one.end());
    list(name + "_lengths", lengths);
    list(name, all);
    if (!restores()) return;
    a.clear();
    auto next = all.begin();
    for (const int64_t n : lengths) a.emplace_back(next, next + n), next += n;
  }

  // --- on the ranks that have them
  /// [block][width]; or empty. `fill`: of other ranks' blocks if the array is made now.
  template <class C>
  void blocks(const std::string& name, C& container, size_t width, Item<C> fill = {}) {
    rows(name, keys_->blocks, container, width, keys_->all_blocks * width, fill);
  }
  /// [place among this rank's blocks of the body][width]; or empty.
  template <class C>
  void body_blocks(const std::string& name, int body, C& container, size_t width) {
    const Rows& rows_of_body = keys_->of_body[size_t(body)];
    rows(name, rows_of_body, container, width, rows_of_body.mine.size() * width, {});
  }
  /// [element][width]; or empty.
  template <class C>
  void elements(const std::string& name, C& container, size_t width = 1) {
    rows(name, keys_->elements, container, width, keys_->all_elements * width, {});
  }
  /// [node], known at the nodes of this rank's elements.
  template <class C>
  void nodes(const std::string& name, C& container) {
    rows(name, keys_->nodes, container, 1, keys_->all_nodes, {});
  }

 private:
  struct Rows {
    std::vector<int32_t> name, mine;  // of this rank's rows: name in the file, place in the array
    std::vector<int64_t> place;       // when restoring: in the file
  };
  struct Keys {
    Rows blocks, elements, nodes;
    std::vector<Rows> of_body;
    size_t all_blocks = 0, all_elements = 0, all_nodes = 0;
  };
  static Keys keys_of(const Mesh& mesh, const Elements& elements);
  template <class Visit>
  static void for_keys(Keys& keys, const Visit& visit);
  Archive() = default;

  template <class C>
  void rows(const std::string& name, const Rows& rows, C& container, size_t width, size_t whole, Item<C> fill) {
    using T = Item<C>;
    if (width == 0) return;
    if (to_) {
      std::vector<T> mine;
      if (container.size() > 0)
        for (const int32_t i : rows.mine) {
          const auto from = container.begin() + ptrdiff_t(size_t(i) * width);
          mine.insert(mine.end(), from, from + ptrdiff_t(width));
        }
      if constexpr (h5::Value<T>)
        to_->rows(name, mine, int(width));
      else
        to_->rows(name, mine);
      return;
    }
    const std::vector<T> all = from_->rows<T>(name);
    if (all.empty()) return container.resize(0);
    if (container.size() != whole) container.resize(0), container.resize(whole, fill);
    for (size_t i = 0; i < rows.mine.size(); ++i)
      std::copy_n(all.begin() + rows.place[i] * ptrdiff_t(width), width,
                  container.begin() + ptrdiff_t(size_t(rows.mine[i]) * width));
  }

  std::optional<Saved> to_;
  std::optional<Restored> from_;
  std::shared_ptr<const Keys> keys_;
};

}  // namespace bw::csd
