import contextlib
import io
import os
import re
import tempfile
import unittest

from support import SOURCES


class Page(unittest.TestCase):
    def test_the_page_runs_as_it_stands(self):
        text = (SOURCES / "docs/python.md").read_text()
        blocks = re.findall(r"```python\n(.*?)```", text, re.S)
        self.assertGreater(len(blocks), 6)
        printed = io.StringIO()
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.symlink(SOURCES / "products", os.path.join(folder, "products"))
            os.chdir(folder)
            try:
                with contextlib.redirect_stdout(printed):
                    scope = {}
                    for block in blocks:
                        exec(compile(block, "docs/python.md", "exec"), scope)
            finally:
                os.chdir(before)
        for part in ["38 parts", "not-found", "interference", "True 843a85d5bc4c76e4176ead5c0adc7136", "True", "seated", "10 of 10"]:
            self.assertIn(part, printed.getvalue())


if __name__ == "__main__":
    unittest.main()
