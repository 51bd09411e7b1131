"""HVAS: feel an assembly before anyone cuts metal.

    import hvas
    product = hvas.open("gear_pump.step")
    model = hvas.prepare(product)
    outcome = model.assemble()

All lengths are in metres, forces in newtons, angles in radians.
"""

import pathlib as _pathlib

from . import fits
from ._hvas import STATES, Model, Product, Record, Run, __version__
from ._hvas import open_product as _open_product
from ._hvas import prepare as _prepare
from .types import ArgumentTypeError, Error

__all__ = ["ArgumentTypeError", "Error", "Model", "Product", "Record", "Run", "STATES", "__version__", "export", "fits", "open", "prepare"]


def _texts(name, values):
    """A list of the texts; a single text would be taken for its letters."""
    try:
        texts = [] if isinstance(values, (str, bytes)) else list(values)
    except TypeError:
        texts = [None]
    if isinstance(values, (str, bytes)) or not all(isinstance(text, str) for text in texts):
        raise ArgumentTypeError(f"{name} has to be a sequence of texts, not {values!r}")
    return texts


def open(file, *, fits=(), unit=None, encoding="", apart=(), rigid=(), cache=True, time_limit=120.0, progress=None):
    """Opens a CAD file: STEP, IGES, a mesh file or a folder of meshes.

    Args:
        file: Path of the file.
        fits: Fits to assign, as "AXIS=H7/g6"; they take precedence over those of the file.
        unit: Unit of length of the file, whatever it states [m]; None: what it states.
        encoding: Encoding of names in a STEP file, as iconv names it; empty: it is guessed.
        apart: What is not to be welded into one body; ["all"]: nothing.
        rigid: Parts that may not give on their way; ["all"]: none.
        cache: Uses the caches on disk.
        time_limit: Time after which opening ends with an error [s].
        progress: Called with a stage and a fraction of 0 to 1. What it raises ends the work.

    Returns:
        A Product; what was odd about the file is in its `diagnostics`.

    Raises:
        hvas.Error: with what happened, where, and a remedy.
        ValueError, TypeError: for an argument that is out of its range, or of another type, as everywhere in the package.
    """
    return _open_product(file, _texts("fits", fits), unit, encoding, _texts("apart", apart), _texts("rigid", rigid), cache, time_limit, progress)


def prepare(product, *, seed=1, base="", first_parts=(), cache=True, progress=None):
    """Prepares a product: contact shapes, fits with sizes drawn by the seed, the order of assembly.

    Args:
        product: As `open` gives it.
        seed: Draws the actual sizes of the fits. `Model.with_seed` draws others without the work.
        base: Name, path or id ("o12") of the part that stays in the fixture; empty: it is found.
        first_parts: Names, paths or ids of parts that come first.
        cache: Uses the cache of contact shapes on disk.
        progress: As for `open`.

    Raises:
        hvas.Error
    """
    return _prepare(product, seed, base, _texts("first_parts", first_parts), cache, progress)


def export(product, file):
    """Writes a product for a simulator: .mjcf or .xml (MuJoCo), .urdf with its meshes beside it, or .usda.

    Returns:
        The files that were written.

    Raises:
        ValueError: for another extension.
        OSError: where a file cannot be written.
    """
    file = _pathlib.Path(file)
    format = file.suffix.lower().lstrip(".")
    if format not in ("mjcf", "xml", "urdf", "usda"):
        raise ValueError(f"{file}: the extension has to be .mjcf, .xml, .urdf or .usda")
    written = []
    for path, contents in product.export_files(format, file.stem).items():
        target = file if path == f"{file.stem}.{format}" else file.parent / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(contents)
        written.append(target)
    return written
