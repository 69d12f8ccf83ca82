// SPDX-License-Identifier: Apache-2.0
// A material as in the case file: `kind` and its keys, or `library` and what is to differ from it.
#pragma once
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "csd/material/failure_data.h"
#include "csd/material/list.h"

namespace bw::csd {

struct RateCase {
  RateLaws law;
  template <class K>
  void describe(K& k) {
    k.pick("kind", law, "rate law", true);
  }
};

/// `kind = "j2"`: the flow stress is chosen inside.
struct J2Case : Elastic {
  static constexpr auto name = "j2";
  Heat heat;
  Flows flow;
  std::optional<RateCase> rate;

  template <class K>
  void describe(K& k) {
    Elastic::describe(k);
    struct FlowTable {
      Flows& flow;
      void describe(K& k) { k.pick("kind", flow, "flow stress", true); }
    } table{flow};
    k.table("flow", table, "flow stress as a function of the equivalent plastic strain eqps");
    k.table("rate", rate, "what a rate of plastic strain does to flow stresses that have no rate of their own");
    k.table("heat", heat, "heating by plastic work, where it happens");
    k.expect(!rate || flow.index() < 3, "rate", "no rate law: this flow stress has its own");
  }
};

using MaterialKinds = std::variant<J2Case, NeoHooke>;

/// Reads keys of which all may be absent, since a value stands there already; shock data for who chooses that law.
template <class K>
struct Overrides {
  K& keys;
  const MieGruneisen& hugoniot;

  template <class... Args>
  void required(Args&&... args) {
    keys.optional(std::forward<Args>(args)...);
  }
  template <class... Args>
  void optional(Args&&... args) {
    keys.optional(std::forward<Args>(args)...);
  }
  void expect(bool holds, const char* key, const std::string& what) { keys.expect(holds, key, what); }

  template <class T>
  void table(const char* key, T& value, const char* doc) {
    struct Inside {
      T& value;
      const MieGruneisen& hugoniot;
      void describe(K& k) {
        Overrides inside{k, hugoniot};
        value.describe(inside);
      }
    } inside{value, hugoniot};
    keys.table(key, inside, doc);
  }
  template <class T>
  void table(const char* key, std::optional<T>& value, const char* doc) {
    keys.table(key, value, doc);
  }
  /// Another alternative than the one held starts afresh: its required keys are required.
  template <class... Ts>
  void pick(const char* key, std::variant<Ts...>& value, const char* doc, bool = false) {
    const std::vector<std::string> names{Ts::name...};
    std::string word = names[value.index()];
    keys.choice(key, word, names, doc);
    const auto read = [&]<class T>(std::type_identity<T>) {
      if (word != T::name) return;
      if constexpr (std::is_same_v<T, MieGruneisen>) {
        if (!std::holds_alternative<T>(value)) value.template emplace<T>(T(hugoniot));
      } else if (!std::holds_alternative<T>(value)) {
        return value.template emplace<T>().describe(keys);
      }
      std::get<T>(value).describe(*this);
    };
    (read(std::type_identity<Ts>()), ...);
  }
};

/// A material with its name, where its numbers come from, its shock data and what is known of its failure.
struct LibraryEntry {
  std::string name, source;
  MaterialKinds material;
  MieGruneisen hugoniot{};  ///< c0 = 0: not known
  FailureData failure{};
};
/// All of them, in the manual's order.
const std::vector<LibraryEntry>& material_library();

struct MaterialCase {
  MaterialKinds choice;
  std::string library = "none";
  FailureData failure;

  template <class K>
  void describe(K& k) {
    std::vector<std::string> names{"none"};
    for (const LibraryEntry& entry : material_library()) names.push_back(entry.name);
    k.choice("library", library, names, "a material by name; keys given beside it replace its numbers");
    const LibraryEntry* found = nullptr;
    for (const LibraryEntry& entry : material_library())
      if (entry.name == library) found = &entry;
    if (found) {
      choice = found->material, failure = found->failure;
      Overrides<K> changes{k, found->hugoniot};
      changes.pick("kind", choice, "material");
    } else {
      k.pick("kind", choice, "material", true);
    }
    failure.describe(k);
    if (failure.melting_temperature == 0) failure.melting_temperature = melting_temperature_of_flow();
  }

  /// K; 0: the flow stress has none.
  double melting_temperature_of_flow() const {
    const auto* j2 = std::get_if<J2Case>(&choice);
    const auto* flow = j2 ? std::get_if<JohnsonCook>(&j2->flow) : nullptr;
    return flow ? flow->T_melt : 0;
  }
};

Materials make_material(const MaterialCase& cs);

}  // namespace bw::csd
