// SPDX-License-Identifier: Apache-2.0
// Writes JSON objects: names in the order of their adding, numbers with all their digits, NaN and infinity as null.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace bw {

class JsonObject {
 public:
  void add(const std::string& name, double value);
  void add(const std::string& name, int64_t value);
  void add(const std::string& name, int value) { add(name, int64_t(value)); }
  void add(const std::string& name, bool value);
  void add(const std::string& name, const std::string& value);
  void add(const std::string& name, const char* value) { add(name, std::string(value)); }
  void add(const std::string& name, const std::vector<double>& values);
  void add(const std::string& name, const std::vector<JsonObject>& values);
  void add(const std::string& name, const JsonObject& value);
  bool empty() const { return members_.empty(); }
  /// Indented by two blanks a level.
  std::string text(int level = 0) const;

 private:
  struct Member {
    std::string name, value;  ///< value: as it is printed, if there are no objects
    std::vector<JsonObject> objects;
    bool is_object = false, is_list = false;
  };
  std::vector<Member> members_;
};

}  // namespace bw
