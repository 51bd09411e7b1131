"""Where the tests find products and the built program."""

import os
import pathlib

SOURCES = pathlib.Path(os.environ.get("HVAS_SOURCES", pathlib.Path(__file__).resolve().parents[2]))
BUILD = pathlib.Path(os.environ.get("HVAS_BUILD", SOURCES / "build/release"))
PRODUCTS = SOURCES / "products"
