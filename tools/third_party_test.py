#!/usr/bin/env python3
"""THIRD-PARTY.md names all that is shipped, and tools/third_party.py notices what it lacks."""

import json
import unittest

import third_party

TEXT = (third_party.ROOT / "THIRD-PARTY.md").read_text()
LOCK = (third_party.ROOT / "web/package-lock.json").read_text()


def lock_with(name, entry):
    lock = json.loads(LOCK)
    lock["packages"][f"node_modules/{name}"] = entry
    return json.dumps(lock)


class ThirdPartyTest(unittest.TestCase):
    def test_names_all_that_is_shipped(self):
        self.assertEqual(third_party.check(TEXT, LOCK), [])

    def test_a_bundled_package_without_an_entry_is_noticed(self):
        wrong = third_party.check(TEXT, lock_with("left-over", {"version": "1.0.0"}))
        self.assertEqual(wrong, ["left-over 1.0.0 is bundled into the page and has no entry"])
        nested = third_party.check(TEXT, lock_with("three/node_modules/@a/b", {"version": "2.0.0"}))
        self.assertEqual(nested, ["@a/b 2.0.0 is bundled into the page and has no entry"])

    def test_a_package_for_development_needs_none(self):
        self.assertEqual(third_party.check(TEXT, lock_with("tool", {"version": "1.0.0", "dev": True})), [])

    def test_another_version_is_noticed(self):
        wrong = third_party.check(TEXT, lock_with("three", {"version": "0.1.0"}))
        self.assertEqual(len(wrong), 1)
        self.assertIn("three 0.1.0", wrong[0])

    def test_every_entry_that_goes_is_noticed(self):
        for name, version in third_party.titles(TEXT).items():
            with self.subTest(name):
                head = f"### {name} {version}\n"
                begin = TEXT.index(head)
                end = min(at for at in (TEXT.find("\n### ", begin + 1), TEXT.find("\n## ", begin), len(TEXT)) if at > 0)
                self.assertTrue(third_party.check(TEXT[:begin] + TEXT[end + 1:], LOCK))
                self.assertTrue(third_party.check(TEXT[:begin] + head + TEXT[end:], LOCK))

    def test_an_entry_of_what_is_not_shipped_is_noticed(self):
        more = TEXT + "\n### ghost 1.0\n\n```text\n" + "All rights reserved. " * 3 + "\n```\n"
        self.assertEqual(third_party.check(more, LOCK),
                         ["ghost has an entry, and is neither in the program nor in the page"])

    def test_a_path_of_a_machine_is_noticed(self):
        self.assertEqual(len(third_party.check(TEXT + "\nsee /usr/share/doc\n", LOCK)), 1)


if __name__ == "__main__":
    unittest.main()
