// SPDX-License-Identifier: Apache-2.0
// Reading case files: what is accepted, and what every mistake is answered with.
#include "common/io/keys.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "common/math/random.h"

using namespace bw;

namespace {

struct Linear {
  double sigma_Y = 0, K_iso = 0;
  static constexpr auto name = "linear";
  template <class K>
  void describe(K& k) {
    k.required("yield_stress", sigma_Y, dim::pressure, "sigma_Y, eq (8)");
    k.optional("hardening", K_iso, dim::pressure, "K, eq (8)");
    k.expect(sigma_Y > 0, "yield_stress", "a positive stress");
  }
};
struct Saturation {
  double sigma_0 = 3e8, sigma_inf = 5e8;
  static constexpr auto name = "saturation";
  template <class K>
  void describe(K& k) {
    k.optional("start", sigma_0, dim::pressure, "first yield");
    k.optional("end", sigma_inf, dim::pressure, "last yield");
  }
};
struct J2 {
  double rho = 0;
  std::variant<Linear, Saturation> flow;
  struct FlowTable {
    std::variant<Linear, Saturation>& flow;
    template <class K>
    void describe(K& k) {
      k.pick("kind", flow, "flow rule", true);
    }
  };
  static constexpr auto name = "j2";
  template <class K>
  void describe(K& k) {
    k.required("density", rho, dim::density, "mass density");
    FlowTable t{flow};
    k.table("flow", t, "yield stress over plastic strain");
  }
};
struct NeoHooke {
  double rho = 0, E = 1e9;
  static constexpr auto name = "neo_hooke";
  template <class K>
  void describe(K& k) {
    k.required("density", rho, dim::density, "mass density");
    k.optional("young_modulus", E, dim::pressure, "E");
  }
};
struct Material {
  std::variant<J2, NeoHooke> model;
  template <class K>
  void describe(K& k) {
    k.pick("kind", model, "constitutive model");
  }
};
struct Body {
  std::string name = "unnamed";
  Material material;
  Vec3 velocity;
  template <class K>
  void describe(K& k) {
    k.optional("name", name, "shown in the output");
    k.table("material", material, "what it is made of");
    k.optional("velocity", velocity, dim::velocity, "at the start");
  }
};
struct Fracture {
  double limit = 0.3;
  bool smoothing = true;
  template <class K>
  void describe(K& k) {
    k.required("limit", limit, dim::none, "equivalent plastic strain");
    k.optional("smoothing", smoothing, "mean over the nodes");
  }
};
struct Solid {
  std::vector<Body> body;
  std::optional<Fracture> fracture;
  int threads = 0;
  std::vector<double> times;
  std::vector<Vec3> points;
  std::vector<int> cells{1, 2, 3};
  std::vector<std::string> faces;
  std::string filter = "plain";
  double dt_max = std::numeric_limits<double>::infinity();
  template <class K>
  void describe(K& k) {
    k.optional("threads", threads, "0 = all");
    k.tables("body", body, "bodies");
    k.table("fracture", fracture, "cracks");
    k.optional("times", times, dim::time, "when");
    k.optional("points", points, dim::length, "where");
    k.optional("cells", cells, "how many");
    k.optional("faces", faces, "names of sets");
    k.choice("filter", filter, {"off", "plain", "self_adjoint"}, "pressure filter");
    k.optional("dt_max", dt_max, dim::time, "longest step");
  }
};

const char* const good = R"(title = "a case"
[solid]
threads = 2
times = [0, "1 us", 2e-6]
points = [[0, "1 cm", 0], ["2 mm", 0, 0]]
faces = ["outer", "inner"]
filter = "self_adjoint"
[[solid.body]]
name = "case"
material = {kind = "j2", density = "7.76 g/cm^3", flow = {kind = "linear", yield_stress = "1.283e10 dyn/cm^2"}}
velocity = [0, 0, "-0.3 km/s"]
[[solid.body]]
[solid.body.material]
kind = "neo_hooke"
density = 1000
[solid.fracture]
limit = 0.25
[fluid]
what = "ever"
)";

Solid read(const std::string& text) {
  Keys k = Keys::read_text(text, "case.toml");
  Solid s;
  std::string title;
  k.optional("title", title, "free text");
  k.table("solid", s, "the solid");
  k.finish({"fluid"});
  return s;
}

/// The message of the error that reading the text ends in.
std::string error_of(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

/// `good` with one piece replaced.
std::string changed(const std::string& from, const std::string& to) {
  std::string text = good;
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST(Keys, reads_every_kind_of_value) {
  const Solid s = read(good);
  EXPECT_EQ(s.threads, 2);
  EXPECT_EQ(s.times, (std::vector<double>{0, 1e-6, 2e-6}));
  EXPECT_EQ(s.points, (std::vector<Vec3>{{0, 0.01, 0}, {0.002, 0, 0}}));
  EXPECT_EQ(s.cells, (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(s.faces, (std::vector<std::string>{"outer", "inner"}));
  EXPECT_EQ(s.filter, "self_adjoint");
  ASSERT_EQ(s.body.size(), 2u);
  EXPECT_EQ(s.body[0].velocity, (Vec3{0, 0, -300}));
  const J2& j2 = std::get<J2>(s.body[0].material.model);
  EXPECT_DOUBLE_EQ(j2.rho, 7760);
  EXPECT_DOUBLE_EQ(std::get<Linear>(j2.flow).sigma_Y, 1.283e9);
  EXPECT_EQ(std::get<NeoHooke>(s.body[1].material.model).rho, 1000);
  ASSERT_TRUE(s.fracture);
  EXPECT_EQ(s.fracture->limit, 0.25);
}

TEST(Keys, optional_table_stays_empty) { EXPECT_FALSE(read("[solid]\n").fracture); }

TEST(Keys, lists_of_tables_may_stand_in_line) {
  const Solid s = read(
      "[solid]\nbody = [{name = \"a\", material = {kind = \"neo_hooke\", density = 1}},\n {material = {kind = "
      "\"neo_hooke\", density = 2}}]");
  ASSERT_EQ(s.body.size(), 2u);
  EXPECT_EQ(s.body[1].name, "unnamed");
}

TEST(Keys, errors_name_place_key_and_expectation) {
  const std::pair<std::string, std::string> cases[] = {
      {changed("threads", "thraeds"), "case.toml:3: solid.thraeds: unknown key; did you mean \"threads\"?"},
      {changed("[fluid]", "[fluidd]"), "case.toml:18: fluidd: unknown table; did you mean \"fluid\"?"},
      {changed("[solid.fracture]", "[solid.fractures]"),
       "case.toml:16: solid.fractures: unknown table; did you mean \"fracture\"?"},
      {changed("limit = 0.25", "limt = 0.25"),
       "case.toml:16: solid.fracture.limit: missing; expected a plain number: equivalent plastic strain; line 17 has "
       "\"limt\""},
      {changed("density = 1000\n", ""),
       "case.toml:13: solid.body[1].material.density: missing; expected a density (kg/m^3): mass density"},
      {changed("7.76 g/cm^3", "7.76 g/cm^2"),
       "case.toml:10: solid.body[0].material.density: expected a density (kg/m^3), got \"7.76 g/cm^2\": a quantity in "
       "kg/m^2"},
      {changed("7.76 g/cm^3", "7.76"),
       "case.toml:10: solid.body[0].material.density: expected a density (kg/m^3), got \"7.76\": a unit is missing (a "
       "number without quotes is SI)"},
      {changed("7.76 g/cm^3", "7.76 gg/cm^3"),
       "case.toml:10: solid.body[0].material.density: expected a density (kg/m^3), got \"7.76 gg/cm^3\": unknown unit "
       "\"gg\" (--manual lists the units)"},
      {changed("density = 1000", "density = true"),
       "case.toml:15: solid.body[1].material.density: expected a density (kg/m^3), got true"},
      {changed("density = 1000", "density = nan"),
       "case.toml:15: solid.body[1].material.density: expected a density (kg/m^3), got nan"},
      {changed("density = 1000", "density = inf"),
       "case.toml:15: solid.body[1].material.density: expected a density (kg/m^3), got inf"},
      {changed("density = 1000", "density = 1000\nyield_stress = 3"),
       "case.toml:16: solid.body[1].material.yield_stress: unknown key for kind = \"neo_hooke\"; expected one of "
       "density, kind, young_modulus"},
      {changed("\"linear\"", "\"linaer\""),
       "case.toml:10: solid.body[0].material.flow.kind: expected one of \"linear\", \"saturation\", got \"linaer\"; "
       "did you mean \"linear\"?"},
      {changed("kind = \"linear\", ", ""),
       "case.toml:10: solid.body[0].material.flow.kind: missing; expected one of \"linear\", \"saturation\": flow "
       "rule"},
      {changed("1.283e10 dyn", "-1 dyn"),
       "case.toml:10: solid.body[0].material.flow.yield_stress: expected a positive stress, got \"-1 dyn/cm^2\""},
      {changed("\"-0.3 km/s\"]", "\"-0.3 km/s\", 1]"),
       "case.toml:11: solid.body[0].velocity: expected a list of 3 numbers, each a velocity (m/s), got [0, 0, \"-0.3 "
       "km/s\", 1]"},
      {changed("-0.3 km/s", "-0.3 km"),
       "case.toml:11: solid.body[0].velocity[2]: expected a velocity (m/s), got \"-0.3 km\": a length (m)"},
      {changed("threads = 2", "threads = 2.5"), "case.toml:3: solid.threads: expected a whole number, got 2.5"},
      {changed("threads = 2", "threads = 3000000000"),
       "case.toml:3: solid.threads: expected a whole number below 2^31 in size, got 3000000000"},
      {changed("times = [0", "times = [[0]"), "case.toml:4: solid.times[0]: expected a time (s), got [0]"},
      {changed("times = [0, \"1 us\", 2e-6]", "times = 1"),
       "case.toml:4: solid.times: expected a list of numbers, each a time (s), got 1"},
      {changed("\"outer\"", "3"), "case.toml:6: solid.faces[0]: expected a text, got 3"},
      {changed("self_adjoint", "selfadjoint"),
       "case.toml:7: solid.filter: expected one of \"off\", \"plain\", \"self_adjoint\", got \"selfadjoint\"; did you "
       "mean \"self_adjoint\"?"},
      {changed("[solid.fracture]\nlimit = 0.25", "[solid.fracture]\nlimit = 0.25\nsmoothing = 1"),
       "case.toml:18: solid.fracture.smoothing: expected true or false, got 1"},
      {changed("name = \"case\"", "name = 1979-05-27"),
       "case.toml:9: solid.body[0].name: expected a text, got a date or time"},
      {"[solid]\nbody = {name = \"a\"}",
       "case.toml:2: solid.body: expected a list of tables ([[solid.body]]), got a table"},
      {"[solid]\nbody = [1]", "case.toml:2: solid.body[0]: expected a table, got 1"},
      {"[solid]\nfracture = 1", "case.toml:2: solid.fracture: expected a table, got 1: cracks"},
      {"[solid]\nthreads = ", "case.toml:2: not valid TOML: "},
      {"[solid]\nthreads = 1\nthreads = 2", "case.toml:3: not valid TOML: "},
      {"[!Y", "case.toml:1: not valid TOML: "},
      {"[solid]\nx = \"\xff\xfe\"", "case.toml:2: not valid TOML: "},
  };
  for (const auto& [text, expected] : cases) EXPECT_EQ(error_of(text).substr(0, expected.size()), expected);
}

TEST(Keys, a_file_that_is_none) {
  EXPECT_THROW(Keys::read_file("/nowhere/case.toml"), InputError);
  EXPECT_THROW(Keys::read_file("/tmp"), InputError);
}

TEST(Keys, places_for_errors_found_later) {
  const std::string path = testing::TempDir() + "bw_case.toml";
  std::ofstream(path) << "a = 1\n[t]\nb = 2\n";
  Keys k = Keys::read_file(path);
  int a = 0;
  k.optional("a", a, "");
  EXPECT_EQ(k.where("a"), path + ":1: a");
  EXPECT_EQ(k.where("absent"), path + ": absent");
  EXPECT_TRUE(k.has("t"));
  EXPECT_FALSE(k.has("u"));
  EXPECT_EQ(k.resolve_path("mesh/x.msh"), testing::TempDir() + "mesh/x.msh");
  EXPECT_EQ(k.resolve_path("/mesh/x.msh"), "/mesh/x.msh");
  struct Table {
    int b = 0, c = 0;
    void describe(Keys& t) {
      t.required("b", b, "");
      t.optional("c", c, "");
      t.expect(c > 0, "c", "something above 0");
    }
  } table;
  try {
    k.table("t", table, "");
    ADD_FAILURE();
  } catch (const InputError& e) {
    EXPECT_EQ(e.what(), path + ":2: t.c: expected something above 0");  // the table's line, as c is absent
  }
  EXPECT_THROW(k.fail("a", "not so"), InputError);
}

TEST(Keys, endless_names_are_refused) {
  std::string text = "a";
  for (int i = 0; i < 200000; ++i) text += ".a";
  EXPECT_THROW(read(text + " = 1"), InputError);
  EXPECT_THROW(read("x = " + std::string(100000, '[')), InputError);
}

TEST(Keys, random_mutations_parse_or_are_input_errors) {
  const std::string alphabet = "[]{}=\"'.,#\n\\ 0129aeux_-+\t\xc3\xa9\xff";
  int errors = 0;
  for (uint64_t trial = 0; trial < 20000; ++trial) {
    std::string text = good;
    const int changes = 1 + int(mix64(trial) % 4);
    for (int c = 0; c < changes; ++c) {
      const auto random = [&](uint64_t event, size_t n) {
        return size_t(uniform01(7, trial, uint64_t(8 * c) + event) * double(n));
      };
      const size_t at = random(0, text.size()), n = 1 + random(1, 12);
      switch (random(2, 4)) {
        case 0:
          text.erase(at, n);
          break;
        case 1:
          text.insert(at, 1, alphabet[random(3, alphabet.size())]);
          break;
        case 2:
          text[at] = alphabet[random(3, alphabet.size())];
          break;
        case 3:
          text.insert(at, text.substr(random(4, text.size()), n));
          break;
      }
    }
    try {
      read(text);
    } catch (const InputError& e) {
      ++errors;
      ASSERT_EQ(std::string(e.what()).substr(0, 9), "case.toml") << e.what();
    }
  }
  EXPECT_GT(errors, 10000);
}

TEST(Keys, manual_lists_every_key_of_every_alternative) {
  Keys k = Keys::manual();
  Solid s;
  k.table("solid", s, "the solid");
  EXPECT_TRUE(s.body.empty());
  EXPECT_FALSE(s.fracture);
  const std::string text = k.manual_text();
  for (const char* piece : {
           "## solid    (table)\n",
           "- `threads` : whole number; default 0\n      0 = all\n",
           "- `dt_max` : number [s]; default unlimited\n",
           "- `filter` : one of \"off\", \"plain\", \"self_adjoint\"; default \"plain\"\n",
           "- `cells` : list of whole numbers; default [1, 2, 3]\n",
           "### solid.body[]    (any number of tables)\n",
           "### solid.body[].material    (table)\n",
           "- `kind` : one of \"j2\", \"neo_hooke\"; default \"j2\"\n",
           "### solid.body[].material(kind = \"j2\")\n",
           "- `density` : number [kg/m^3]; required\n      mass density\n",
           "### solid.body[].material(kind = \"neo_hooke\")\n",
           "- `young_modulus` : number [Pa]; default \"1e+09 Pa\"\n",
           "### solid.body[].material(kind = \"j2\").flow(kind = \"linear\")\n",
           "flow(kind = \"saturation\")\n",
           "- `start` : number [Pa]; default \"3e+08 Pa\"\n",
           "### solid.fracture    (table, may be absent)\n",
           "- `smoothing` : true or false; default true\n",
       })
    EXPECT_NE(text.find(piece), std::string::npos) << piece << "\n----\n" << text;
}
