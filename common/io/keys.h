// SPDX-License-Identifier: Apache-2.0
// Input: every struct that comes from the case file has one describe(Keys&) that names key, default, dimension and meaning;
// the same text reads the file, reports errors and writes the manual.
//
//   struct LinearFlow {
//     double sigma_Y = 0, K_iso = 0;
//     static constexpr auto name = "linear";
//     template <class Keys> void describe(Keys& k) {
//       k.required("yield_stress", sigma_Y, dim::pressure, "sigma_Y, eq (8)");
//       k.optional("hardening", K_iso, dim::pressure, "K, eq (8)");
//       k.expect(sigma_Y > 0, "yield_stress", "a positive stress");
//     }
//   };
//
// Numbers are SI; a string carries its unit ("1.283e10 dyn/cm^2", "7.76 g/cm^3", "150 us", "25 degC"). An unknown or missing key, a
// wrong type or dimension is an InputError "file:line: key: what was expected", with the nearest known name.
#pragma once
#include <concepts>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/app/error.h"
#include "common/io/quantity.h"
#include "common/math/tensor.h"
#include "common/math/units.h"

namespace bw {

class Keys {
 public:
  struct Impl;  // a table being read, or the manual being written

  /// Reads the file. InputError on syntax errors (with line).
  static Keys read_file(const std::string& path);
  static Keys read_text(const std::string& text, const std::string& name = "input");  ///< name stands for the file in messages
  /// A Keys that only collects the manual; every describe() is walked once, lists and optional tables too.
  static Keys manual();
  std::string manual_text() const;

  // --- scalars, texts, points, lists: the member's value on entry is the default of optional() --------------------------
  void required(const char* key, double& value, Dim dim, const char* doc) { number(key, value, dim, doc, true); }
  void optional(const char* key, double& value, Dim dim, const char* doc) { number(key, value, dim, doc, false); }
  void required(const char* key, Vec3& value, Dim dim, const char* doc) { point(key, value, dim, doc, true); }
  void optional(const char* key, Vec3& value, Dim dim, const char* doc) { point(key, value, dim, doc, false); }
  void required(const char* key, std::vector<double>& value, Dim dim, const char* doc) { numbers(key, value, dim, doc, true); }
  void optional(const char* key, std::vector<double>& value, Dim dim, const char* doc) { numbers(key, value, dim, doc, false); }
  void required(const char* key, std::vector<Vec3>& value, Dim dim, const char* doc) { points(key, value, dim, doc, true); }
  void optional(const char* key, std::vector<Vec3>& value, Dim dim, const char* doc) { points(key, value, dim, doc, false); }
  void required(const char* key, int& value, const char* doc) { integer(key, value, doc, true); }
  void optional(const char* key, int& value, const char* doc) { integer(key, value, doc, false); }
  void required(const char* key, std::vector<int>& value, const char* doc) { integers(key, value, doc, true); }
  void optional(const char* key, std::vector<int>& value, const char* doc) { integers(key, value, doc, false); }
  void required(const char* key, bool& value, const char* doc) { boolean(key, value, doc, true); }
  void optional(const char* key, bool& value, const char* doc) { boolean(key, value, doc, false); }
  void required(const char* key, std::string& value, const char* doc) { text(key, value, doc, true); }
  void optional(const char* key, std::string& value, const char* doc) { text(key, value, doc, false); }
  void optional(const char* key, std::vector<std::string>& value, const char* doc) { texts(key, value, doc, false); }
  void required(const char* key, std::vector<std::string>& value, const char* doc) { texts(key, value, doc, true); }
  /// One of a few words; InputError lists them. The value on entry is the default; required if that is empty.
  void choice(const char* key, std::string& value, const std::vector<std::string>& words, const char* doc);

  // --- tables ---------------------------------------------------------------------------------------------------------
  /// [key]: always walked; absent in the file = all its keys are absent (so its required keys are errors).
  template <class T> void table(const char* key, T& value, const char* doc) {
    Keys sub = open(key, doc, true);
    value.describe(sub);
    close(sub);
  }
  /// [key] that may be absent: value is engaged only if the file has it.
  template <class T> void table(const char* key, std::optional<T>& value, const char* doc) {
    if (!walks(key)) return;
    Keys sub = open(key, doc, false);
    value.emplace();
    value->describe(sub);
    close(sub);
    if (is_manual()) value.reset();
  }
  /// [[key]]: any number of tables.
  template <class T> void tables(const char* key, std::vector<T>& values, const char* doc) {
    const int n = count(key);
    for (int i = 0; i < n; ++i) {
      Keys sub = open_item(key, i, doc);
      T value{};
      value.describe(sub);
      close(sub);
      values.push_back(std::move(value));
    }
    if (is_manual()) values.clear();
  }
  /// Inside a table: `key = "name"` picks the alternative of the variant whose T::name matches and describes it with the
  /// other keys of the same table. Without the key the variant's present alternative is the default, unless required.
  template <class... Ts> void pick(const char* key, std::variant<Ts...>& value, const char* doc, bool is_required = false) {
    const std::vector<std::string> names{Ts::name...};
    if (is_manual()) {
      begin_pick(key, names, int(value.index()), doc, is_required);
      (pick_in_manual<Ts>(key, value), ...);
      return;
    }
    const int chosen = picked(key, names, int(value.index()), doc, is_required);
    int i = 0;
    ((i++ == chosen ? (emplace_unless_held<Ts>(value), std::get<Ts>(value).describe(*this)) : void()), ...);
  }

  /// The value just read is wrong: InputError at the key's place unless the condition holds (not asked in the manual).
  void expect(bool condition, const char* key, const std::string& what_was_expected);
  /// InputError at the key's place, or the table's if the key is absent. Inside describe() use expect().
  [[noreturn]] void fail(const char* key, const std::string& message) const;
  bool has(const char* key) const;
  bool is_manual() const;
  /// "case.toml:12: solid.body[0].mesh" of a key (the table's line, if absent): for errors found later.
  std::string where(const char* key) const;
  /// Paths in the case file are relative to its folder.
  std::string resolve_path(const std::string& path) const;
  /// At the end: InputError if the file holds a key that nobody asked for. Tables named in `others` belong to the other program.
  void finish(const std::vector<std::string>& others = {});

 private:
  explicit Keys(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}
  void number(const char*, double&, Dim, const char*, bool);
  void point(const char*, Vec3&, Dim, const char*, bool);
  void numbers(const char*, std::vector<double>&, Dim, const char*, bool);
  void points(const char*, std::vector<Vec3>&, Dim, const char*, bool);
  void integer(const char*, int&, const char*, bool);
  void integers(const char*, std::vector<int>&, const char*, bool);
  void boolean(const char*, bool&, const char*, bool);
  void text(const char*, std::string&, const char*, bool);
  void texts(const char*, std::vector<std::string>&, const char*, bool);
  bool walks(const char* key) const;  // present in the file, or the manual
  Keys open(const char* key, const char* doc, bool is_required);
  int count(const char* key) const;  // tables in [[key]]; 1 in the manual
  Keys open_item(const char* key, int i, const char* doc);
  void close(Keys& sub);  // unknown keys of the sub-table are errors
  int picked(const char* key, const std::vector<std::string>& names, int fallback, const char* doc, bool is_required);
  void begin_pick(const char* key, const std::vector<std::string>& names, int fallback, const char* doc, bool is_required);
  template <class T, class V> void pick_in_manual(const char* key, const V& held) {
    begin_alternative(key, T::name);
    T value = std::holds_alternative<T>(held) ? std::get<T>(held) : T{};
    value.describe(*this);
    end_alternative();
  }
  void begin_alternative(const char* key, const char* name);
  void end_alternative();
  template <class T, class V> static void emplace_unless_held(V& value) {
    if (!std::holds_alternative<T>(value)) value.template emplace<T>();
  }

  std::shared_ptr<Impl> impl_;
};

}  // namespace bw
