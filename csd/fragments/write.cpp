// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <string_view>

#include "common/io/file.h"
#include "common/io/hdf5.h"
#include "csd/fragments/fragments.h"

namespace bw::csd {
namespace {

template <class T>
void write_column(const h5::Group& group, const char* name, std::span<const Fragment> fragments) {
  std::vector<T> values;
  for (const Fragment& f : fragments)
    f.describe([&](const char* column, const char*, const auto& value) {
      if constexpr (std::same_as<std::decay_t<decltype(value)>, T>)
        if (column == std::string_view(name)) values.push_back(value);
    });
  group.write(name, values);
}

}  // namespace

void write_fragments(const std::string& path, double t, std::span<const Fragment> fragments) {
  std::string text = "t [s]";
  Fragment().describe(
      [&](const char* name, const char* unit, const auto&) { text += fmt::format(",{} [{}]", name, unit); });
  text += '\n';
  for (const Fragment& f : fragments) {
    text += fmt::format("{:.12g}", t);
    f.describe([&]<class T>(const char*, const char*, const T& value) {
      if constexpr (std::same_as<T, double>)
        text += fmt::format(",{:.12g}", value);
      else
        text += fmt::format(",{}", value);
    });
    text += '\n';
  }
  write_atomically(path + ".csv", text);
  const h5::Group group = h5::File::create(path + ".h5").root().group("fragments");
  group.attribute("t", t);
  Fragment().describe([&]<class T>(const char* name, const char* unit, const T&) {
    write_column<T>(group, name, fragments);
    group.attribute(fmt::format("{} unit", name), std::string(unit));
  });
}

}  // namespace bw::csd
