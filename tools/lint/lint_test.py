#!/usr/bin/env python3
"""Tests of the lints: each catches what it is there for, and lets pass what it should."""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import codes  # noqa: E402
import constants  # noqa: E402
import doors  # noqa: E402
import layers  # noqa: E402
import openings  # noqa: E402
import pages  # noqa: E402
import walkthroughs  # noqa: E402
import rt_symbols  # noqa: E402
import tutorials  # noqa: E402
import units  # noqa: E402

TABLE = """
| room | holds | may know | outside libraries |
|---|---|---|---|
| `base` | results | - | fmt |
| `middle` | things | base | - |
| `top` | all | middle | CLI |
"""


class Layers(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)
        self.write("docs/architecture.md", TABLE)

    def write(self, path, text):
        (self.root / path).parent.mkdir(parents=True, exist_ok=True)
        (self.root / path).write_text(text)

    def problems(self):
        rooms, outside = layers.read_table(self.root / "docs/architecture.md")
        reach, libraries = layers.close(rooms, outside)
        return [
            *layers.check_sources(self.root, rooms, reach, libraries),
            *layers.check_links(self.root, rooms, reach, libraries),
        ]

    def test_downward_includes_pass_also_through_other_rooms(self):
        self.write("src/top/a.cc", '#include <vector>\n#include <CLI/CLI.hpp>\n#include "base/x.h"\n#include "top/a.h"\n')
        self.write("src/top/CMakeLists.txt", "hvas_library(top SOURCES a.cc DEPS hvas::middle hvas::base CLI11::CLI11)")
        self.assertEqual(self.problems(), [])

    def test_upward_include_is_caught_with_its_line(self):
        self.write("src/base/a.h", '#pragma once\n#include "middle/m.h"\n')
        self.assertEqual(self.problems(), ['src/base/a.h:2: base may not know middle: #include "middle/m.h"'])

    def test_upward_link_is_caught(self):
        self.write("src/base/CMakeLists.txt", "hvas_library(base SOURCES a.cc DEPS hvas::top)")
        self.assertEqual(len(self.problems()), 1)

    def test_library_of_another_room_is_caught_in_source_and_link(self):
        self.write("src/middle/a.cc", "#include <CLI/CLI.hpp>\n")
        self.write("src/middle/CMakeLists.txt", "hvas_library(middle SOURCES a.cc DEPS CLI11::CLI11)")
        self.assertEqual(len(self.problems()), 2)

    def test_second_library_of_a_room_is_for_that_room(self):
        self.write("src/middle/CMakeLists.txt", "hvas_library(middle_reader SOURCES a.cc DEPS hvas::middle)")
        self.assertEqual(self.problems(), [])
        self.write("src/top/CMakeLists.txt", "hvas_library(top SOURCES a.cc DEPS hvas::middle_reader)")
        self.assertEqual(len(self.problems()), 1)

    def test_unknown_library_is_caught(self):
        self.write("src/base/a.cc", "#include <boost/asio.hpp>\n")
        self.assertEqual(len(self.problems()), 1)

    def test_gtest_is_for_tests(self):
        self.write("src/base/test/a_test.cc", "#include <gtest/gtest.h>\n")
        self.assertEqual(self.problems(), [])
        self.write("src/base/a.cc", "#include <gtest/gtest.h>\n")
        self.assertEqual(len(self.problems()), 1)

    def test_circle_in_the_table_is_caught(self):
        self.write("docs/architecture.md", TABLE.replace("| results | - |", "| results | top |"))
        self.assertRaises(ValueError, self.problems)


class Openings(unittest.TestCase):
    def test_comment_that_begins_in_the_middle_is_caught_with_its_line(self):
        with tempfile.TemporaryDirectory() as folder:
            header = pathlib.Path(folder) / "a.h"
            header.write_text("/** The size. */\nint a;  ///< Of the file.\n/** The same again. */\nint b;  ///< Offers it.\n")
            self.assertEqual([number for _, number, _ in openings.find_openings(pathlib.Path(folder))], [2, 3])


class Doors(unittest.TestCase):
    def test_call_beside_its_door_is_caught_with_its_line(self):
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder) / "src" / "cad" / "a.cc"
            source.parent.mkdir(parents=True)
            source.write_text("int a;\nauto b = nlohmann::json::parse(text);\nauto c = ParseJson<Json>(text);\n")
            (source.parent / "test").mkdir()
            (source.parent / "test" / "b.cc").write_text("auto b = Json::parse(text);\n")
            found = list(doors.find_calls(pathlib.Path(folder)))
            self.assertEqual(len(found), 1)
            self.assertTrue(found[0].startswith("src/cad/a.cc:2: "))


class Constants(unittest.TestCase):
    def bare(self, text):
        return [(number, name) for number, name, _ in constants.find_bare(text.splitlines())]

    def test_constant_without_a_comment_is_caught_with_its_line(self):
        self.assertEqual(self.bare("int a = 1;\n\nconstexpr double kA = 2;\n"), [(3, "kA")])
        self.assertEqual(self.bare("  static constexpr int kA{2};\n"), [(1, "kA")])
        self.assertEqual(self.bare("const double kA = std::cos(1.0);\n"), [(1, "kA")])
        self.assertEqual(self.bare("constexpr std::array<double, 2> kA{\n    1, 2};\n"), [(1, "kA")])

    def test_comment_on_the_line_explains_that_line_alone(self):
        self.assertEqual(self.bare("constexpr int kA = 1;  // Length [m].\nconstexpr int kB = 2;\n"), [(2, "kB")])

    def test_comment_above_explains_a_block_but_not_what_follows_it(self):
        block = "/** Both.\n And more. */\nconstexpr int kA =\n    1;\nconstexpr int kB = 2;\n"
        self.assertEqual(self.bare(block), [])
        self.assertEqual(self.bare(block + "\nconstexpr int kC = 3;\n"), [(7, "kC")])
        self.assertEqual(self.bare(block + "Run();\nconstexpr int kC = 3;\n"), [(7, "kC")])
        self.assertEqual(self.bare("/** Runs. */\nvoid Run() {\n  constexpr int kC = 3;\n}\n"), [(3, "kC")])

    def test_text_and_limits_of_types_need_none(self):
        text = 'constexpr const char* kA = "a";\nconstexpr double kB = std::numeric_limits<double>::infinity();\n'
        self.assertEqual(self.bare(text), [])

    def test_default_of_an_option_is_caught_unless_it_is_nothing(self):
        text = "struct AOptions {\n  double a{0.5};\n  int b{0};\n  double c = 2;  ///< [m]\n  bool d{true};\n};\n"
        self.assertEqual(self.bare(text), [(2, "a")])
        self.assertEqual(self.bare("struct A {\n  double a{0.5};\n};\n"), [])


class Units(unittest.TestCase):
    def unsuffixed(self, text):
        return [number for number, _ in units.find_unsuffixed(text.splitlines())]

    def test_unit_that_is_not_si_asks_for_its_suffix(self):
        self.assertEqual(self.unsuffixed("double a{0};  ///< The size [mm].\ndouble a_mm{0};  ///< [mm]\n"), [1])
        self.assertEqual(self.unsuffixed("double a{0};  ///< The size [m].\n"), [])
        self.assertEqual(self.unsuffixed("std::optional<double> a_c, b;  // [deg C]\n"), [1])
        self.assertEqual(self.unsuffixed("std::array<double, 2> a_um_{};  // [um]\n"), [])
        self.assertEqual(self.unsuffixed("constexpr int kAMs = 1;  // [ms]\nconstexpr int kA = 1;  // [ms]\n"), [2])

    def test_comment_above_belongs_to_what_follows(self):
        self.assertEqual(self.unsuffixed("/** The size\n [um]. */\ndouble size;\ndouble other;\n"), [3])
        self.assertEqual(self.unsuffixed("/** The size [um]. */\n\n/** Any. */\ndouble other;\n"), [])

    def test_parameters_are_told_of_by_name_and_functions_are_free(self):
        self.assertEqual(self.unsuffixed("/** The time [ns]. */\nstd::int64_t Read(double a);\n"), [])
        self.assertEqual(self.unsuffixed("/** Sets it.\n @param a  [mm] @param b  [m] */\nvoid Set(double a, double b);\n"), [3])
        self.assertEqual(self.unsuffixed("/** @param a_mm  The size [mm]. */\nvoid Set(double a_mm);\n"), [])

    def test_units_in_texts_are_no_comments(self):
        self.assertEqual(self.unsuffixed('add("--size", size, "The size [mm]");\n'), [])


class Codes(unittest.TestCase):
    ROWS = {"X9", "N4"}
    SPANS = {"X": range(1, 16)}
    REFERENCES = "| ISO 286-1:2010 | fits |\n| Whitney, J. Dynamic Systems 104, 1982 | jamming |\n"

    def strays(self, name, text):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / name
            path.write_text(text)
            return list(codes.find_strays(path, self.ROWS, self.SPANS, self.REFERENCES))

    def test_what_stands_in_the_tables_passes(self):
        text = "/** Exact (X9), by X(3); fits of ISO 286-1; Whitney,\n J. Dyn. Syst. 104 (1982). */ int N7 = 40; // N4\n"
        self.assertEqual(self.strays("a.h", text), [])

    def test_code_equation_standard_and_paper_that_lead_nowhere_are_caught_with_their_line(self):
        text = "// X9\n// X8, then X(16)\nint a;  // DIN 912\n/* Nobody and\n Noone, J. Nothing 3, 1999 */\n"
        found = self.strays("a.cc", text)
        self.assertEqual([line for line, _ in found], [2, 2, 3, 4])
        for (_, fault), what in zip(found, ["X8", "X(16)", "DIN 912", "Noone, J. Nothing 3, 1999"]):
            self.assertIn(what, fault)

    def test_what_a_document_quotes_is_no_citation(self):
        self.assertEqual(self.strays("a.md", "`N9` is a class; N4 is a requirement"), [])

    def test_requirement_of_a_paper_without_a_test_is_caught(self):
        sources = ["TEST(Fit, W6RisesInStairs) {\nTEST_P(Pull,\n       X10IsBounded) {\n", "// X9\nTEST(X9Test, IsExact) {"]
        self.assertEqual(codes.list_untested({"X9", "X10", "W6", "N4"}, sources), ["X9"])


class Pages(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)
        subprocess.run(["git", "init", "--quiet", self.root], check=True)
        self.write("docs/README.md", "# All pages\n\n[one](one.md)\n")
        self.write("docs/one.md", "# One\n\n## What it does, and why `a_b`\n\n## Twice\n\n## Twice\n")

    def write(self, path, text):
        (self.root / path).parent.mkdir(parents=True, exist_ok=True)
        (self.root / path).write_text(text)

    def problems(self):
        return list(pages.check(self.root))

    def test_pages_that_lead_to_each_other_pass(self):
        self.write("README.md", "[all](docs/), [one](docs/one.md#twice-1) and [why](docs/one.md#what-it-does-and-why-a_b)\n"
                   "[elsewhere](https://example.org/x) [below](#two)\n# Two\n")
        self.assertEqual(self.problems(), [])

    def test_links_to_nothing_are_caught_with_their_line(self):
        self.write("README.md", "\n[gone](docs/gone.md)\n[far](docs/one.md#three)\n<img src=\"docs/no.png\">\n")
        self.assertEqual(self.problems(), [
            "README.md:2: docs/gone.md is not there",
            "README.md:3: docs/one.md has no heading #three",
            "README.md:4: docs/no.png is not there",
        ])

    def test_code_has_no_links(self):
        self.write("README.md", "`[a](b)` and\n```\n[c](d)\n# heading\n```\n``[e](f) ` ``\n")
        self.assertEqual(self.problems(), [])

    def test_page_that_nothing_leads_to_is_caught_also_where_another_lost_one_does(self):
        self.write("docs/lost.md", "[also](deep/lost.md)")
        self.write("docs/deep/lost.md", "[back](../lost.md)")
        self.assertEqual(len(self.problems()), 2)

    def test_picture_that_no_page_shows_is_caught(self):
        self.write("docs/pictures/a.svg", "")
        self.assertEqual(self.problems(), ["docs/pictures/a.svg: no page shows it"])
        self.write("docs/one.md", "![a](pictures/a.svg)")
        self.assertEqual(self.problems(), [])


class Walkthroughs(unittest.TestCase):
    WORDS = {"CalcGap", "FeatureKind", "Pose"}

    def problems(self, text):
        root = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, root)
        (root / "src").mkdir()
        (root / "src/gap.cc").write_text("")
        return list(walkthroughs.check_page(root, "a.md", "The example is `ball_cone`.\n" + text, self.WORDS))

    def test_names_of_the_sources_of_the_page_and_of_its_example_pass(self):
        self.assertEqual(self.problems("`src/gap.cc`, `src/ball_cone.cc`, `CalcGap`\n```cpp\ndouble CalcRest(int a) {\n"
                                       "  return CalcGap(FeatureKind::kBall, \"Nothing()\");  // Nobody()\n}\n"
                                       "TEST(Rest, IsLow) { CalcRest(BallCone()); }\n```\n"), [])

    def test_what_was_renamed_or_moved_is_caught_with_its_line(self):
        self.assertEqual(self.problems("`src/rise.cc` and `CalcRise`\n\n```cpp\n  return\n      Fall(1);\n```\n"),
                         ["a.md:6: Fall is not in src/", "a.md:2: src/rise.cc is not there", "a.md:2: CalcRise is not in src/"])

    def test_page_without_an_example_is_caught(self):
        self.assertEqual(len(list(walkthroughs.check_page(None, "a.md", "text", self.WORDS))), 1)


class Figures(unittest.TestCase):
    def test_those_in_the_documents_are_what_the_script_draws(self):
        root = pathlib.Path(__file__).resolve().parents[2]
        with tempfile.TemporaryDirectory() as name:
            subprocess.run([sys.executable, root / "tools/pictures/figures.py", name], check=True)
            drawn = {path.name: path.read_text() for path in pathlib.Path(name).iterdir()}
        kept = {path.name: path.read_text() for path in (root / "docs/pictures").glob("*.svg")}
        # tools/pictures/curves.py draws this one from what the program calculates.
        self.assertEqual(sorted([*drawn, "fit_curves.svg"]), sorted(kept))
        for name in drawn:
            self.assertEqual(drawn[name], kept[name], f"{name} is old: tools/pictures/make figures")


class Tutorials(unittest.TestCase):
    """The program of these pages is the shell's echo."""

    def faults(self, text, is_update=False):
        with tempfile.TemporaryDirectory() as name:
            page = pathlib.Path(name) / "page.md"
            page.write_text(text)
            found = tutorials.run_page(page, pathlib.Path("/bin/echo"), is_update)
            return page.read_text() if is_update else found

    def test_what_is_printed_passes_also_in_parts_and_with_other_digits_at_the_end(self):
        self.assertEqual(self.faults("```console\n$ hvas a b 1.234\na b 1.25\n$ echo a; echo b; echo c\na\n...\nc\n```\n"), [])

    def test_other_words_numbers_and_states_are_caught_with_their_line(self):
        for shown in ("a c 100", "a b 90", "a b", "a b 100 d"):
            faults = self.faults(f"#\n```console\n$ hvas a b 100\n{shown}\n```\n")
            self.assertEqual(len(faults), 1, shown)
            self.assertIn("page.md:2: $ hvas a b 100", faults[0])
        self.assertEqual(len(self.faults("```console\n$ false\n```\n")), 1)
        self.assertEqual(self.faults("```console\n$ false\n[exit status 1]\n```\n"), [])

    def test_parts_have_to_come_in_their_order(self):
        self.assertEqual(len(self.faults("```console\n$ hvas one two three\n...\nthree\n...\ntwo\n...\n```\n")), 1)

    def test_blocks_are_one_session_with_files_of_the_page(self):
        page = "```yaml file=a.txt\nhere\n```\n```console\n$ mkdir b && cd b\n```\n```sh\nno\n```\n```console\n$ cat ../a.txt\nhere\n```\n"
        self.assertEqual(self.faults(page), [])

    def test_a_server_ends_when_it_has_said_what_is_shown(self):
        self.assertEqual(self.faults('```console until-shown\n$ sh -c "echo up; sleep 100"\nup\n```\n'), [])

    def test_update_writes_what_is_printed_and_keeps_the_cuts(self):
        page = "```console\n$ seq 5\n0\n...\n9\n$ hvas x\ny\n```\n"
        self.assertEqual(self.faults(page, is_update=True), "```console\n$ seq 5\n1\n...\n5\n$ hvas x\nx\n```\n")


# A tick that allocates only behind a local function in another file, and a clean one.
TICK = """
namespace hvas { int Far(int n) noexcept; int Near(int n) noexcept; }
namespace { __attribute__((noinline)) int Step(int n) noexcept { return hvas::Far(n) + 1; } }
namespace hvas {
int Dirty(int n) noexcept { return Step(n) + 1; }
int Clean(int n) noexcept { return Near(n) + 1; }
int SetUp() { return *new int(3); }
}
"""
FAR = """
namespace hvas {
int* kept;
int Far(int n) noexcept { kept = new int(n); return *kept; }
int Near(int n) noexcept { return n * n; }
}
"""


class RtSymbols(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)
        self.objects = {}
        for name, text in {"tick": TICK, "far": FAR}.items():
            source, target = self.root / f"{name}.cc", self.root / f"{name}.cc.o"
            source.write_text(text)
            subprocess.run(["g++", "-O2", "-fPIC", "-c", source, "-o", target], check=True)
            self.objects[f"room/{name}"] = target
        self.addCleanup(setattr, rt_symbols, "ROOTS", rt_symbols.ROOTS)
        self.addCleanup(setattr, rt_symbols, "TICK_ONLY", rt_symbols.TICK_ONLY)

    def reached(self, *roots):
        rt_symbols.ROOTS = list(roots)
        return list(rt_symbols.check_reachable(self.objects))

    def test_allocation_behind_other_files_is_caught_with_its_way(self):
        problems = self.reached(r"hvas::Dirty\(int\)")
        self.assertEqual(len(problems), 1)
        self.assertIn("hvas::Far(int)\n    operator new", problems[0])

    def test_set_up_beside_a_clean_tick_passes(self):
        self.assertEqual(self.reached(r"hvas::Clean\(int\)"), [])

    def test_root_that_is_gone_is_caught(self):
        self.assertEqual(len(self.reached(r"hvas::Gone\(int\)")), 1)

    def test_tick_only_file_that_names_new_is_caught(self):
        rt_symbols.TICK_ONLY = ["room/far", "room/gone"]
        self.assertEqual(len(list(rt_symbols.check_tick_only(self.objects))), 2)


if __name__ == "__main__":
    unittest.main(verbosity=0)
