#!/usr/bin/env python3
"""tools/mutants.py finds the mutants of C++ that it should, and no others; tools/mutate knows equivalent ones."""

import json
import pathlib
import unittest

import mutants

HEAD = "void F() {\n"


def changed(text):
    """What the mutants of some statements make of the line that they change."""
    return {mutant.mutated for mutant in mutants.list_mutants("a.cc", HEAD + text)}


class MutantsTest(unittest.TestCase):
    def test_binary_operators_are_exchanged_and_no_others(self):
        self.assertEqual(changed("const double a = b * c;\n"), {"const double a = b / c;"})
        self.assertEqual(changed("return a < b;\n"), {"return a <= b;", "return a > b;"})
        self.assertEqual(changed("return a != b &&\n    c;\n"), {"return a == b &&", "return a != b ||"})
        self.assertEqual(changed("std::vector<Id> a(T* b, T&& c, T& d);\n"), set())
        self.assertEqual(changed("template <typename T>\nauto operator<(T a) -> T;\n"), set())

    def test_constants_become_zero_one_or_twice_as_large(self):
        self.assertEqual(changed("return 0;\n"), {"return 1;"})
        self.assertEqual(changed("return f(1.0);\n"), {"return f(0.0);", "return f(2.0);"})
        self.assertEqual(changed("return 2.5e-3;\n"), {"return (2 * 2.5e-3);"})
        self.assertEqual(changed("return 1'000'000u;\n"), {"return (2 * 1'000'000u);"})
        self.assertEqual(changed("std::array<double, 3> a2{};\n"), set())

    def test_conditions_are_negated_after_their_initializer(self):
        self.assertIn("if (!(a)) {", changed("if (a) {\n"))
        self.assertIn("while (!(f(a))) {", changed("while (f(a)) {\n"))
        self.assertIn("if (const auto a = f(); !(a)) {", changed("if (const auto a = f(); a) {\n"))
        self.assertEqual(changed("if (const T* a = f()) {\n"), set())
        self.assertEqual(changed("if (!a) {\n"), {"if (a) {"})

    def test_a_condition_of_several_lines_is_negated_as_a_whole(self):
        texts = {mutant.text for mutant in mutants.list_mutants("a.cc", HEAD + "if (a &&\n    b) {\n")}
        self.assertIn(HEAD + "if (!(a &&\n    b)) {\n", texts)

    def test_assignments_and_calls_on_a_line_of_their_own_are_left_out(self):
        for line in ("a = b;", "a->b[c].d += e;", "F(a, b);", "a.f(b)->g();", "++a.b;"):
            self.assertIn(";", changed(line + "\n"), line)
        for line in ("return a;", "const A a = b;", "A a(b);", "break;", "using A = B;", "a.reserve(b);", "f(a"):
            self.assertNotIn(";", changed(line + "\n"), line)
        self.assertNotIn(";", changed("const A a =\n    f(b);\n"), "the end of a declaration")

    def test_min_and_max_and_truth_and_signs_are_exchanged(self):
        self.assertEqual(changed("return std::min(a, b);\n"), {"return std::max(a, b);"})
        self.assertEqual(changed("return true;\n"), {"return false;"})
        self.assertEqual(changed("return -a;\n"), {"return a;"})
        self.assertEqual(changed("return f(-a, -b);\n"), {"return f(a, -b);", "return f(-a, b);"})

    def test_what_is_no_code_has_no_mutants(self):
        for line in ("// a < b", "/* a < 1 */", "#if A < 1", "#define A \\\n  1", 'f = g("a < 1");', "f = g('1');",
                     'f = g(R"x(a < 1)x");', "HVAS_ASSERT(a < 1);"):
            self.assertEqual(changed(line + "\n") - {";"}, set(), line)

    def test_equal_lines_are_told_apart(self):
        found = mutants.list_mutants("a.cc", HEAD + "f = -a;\nf = b;\nf = -a;\n")
        self.assertEqual([m.occurrence for m in found if m.kind == "sign"], [1, 2])
        self.assertEqual([m.number for m in found if m.kind == "sign"], [2, 4])
        self.assertEqual(len({m.key for m in found}), len(found))

    def test_only_the_seed_and_the_mutants_decide_on_their_order(self):
        text = HEAD + "".join(f"a{i} = b{i} + c{i};\n" for i in range(50))
        order = [m.key for m in mutants.draw(mutants.list_mutants("a.cc", text), 1)]
        self.assertEqual(order, [m.key for m in mutants.draw(mutants.list_mutants("a.cc", text), 1)])
        self.assertNotEqual(order, [m.key for m in mutants.draw(mutants.list_mutants("a.cc", text), 2)])
        more = [m.key for m in mutants.draw(mutants.list_mutants("a.cc", text + "d = e;\n"), 1)]
        self.assertEqual([key for key in more if key in order], order)

    def test_a_line_of_a_table_is_drawn_no_more_often_than_another(self):
        table = "".join(f"{{{i}, 2, 3, 4, 5, 6, 7, 8, 9}},\n" for i in range(200))
        rest = "".join(f"a{i} = true;\n" for i in range(10, 210))
        listed = mutants.list_mutants("a.cc", HEAD + table + rest)
        first = mutants.draw(listed, 1)[:100]
        in_table = sum(m.line.startswith("{") for m in first)
        self.assertGreater(in_table, 30, "of 50 that are expected")
        self.assertLess(in_table, 70)

    def test_each_equivalent_mutant_has_a_reason(self):
        entries = json.loads((pathlib.Path(mutants.__file__).parent / "mutants_equivalent.json").read_text())
        for entry in entries:
            self.assertGreater(len(entry["reason"].split()), 3, entry)
            self.assertNotEqual(entry["line"], entry["mutated"], entry)


if __name__ == "__main__":
    unittest.main()
