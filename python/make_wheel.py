#!/usr/bin/env python3
"""Makes a wheel of what is built: make_wheel.py BUILD FOLDER

The wheel has the package, the library and hvas-cad in it, and links what Debian 12 has (the dependencies of the package
python3-hvas); it is no manylinux wheel. The same build gives the same bytes.
"""

import base64
import hashlib
import pathlib
import re
import subprocess
import sys
import tempfile
import zipfile

TAG = "cp311-cp311-linux_x86_64"
METADATA = """Metadata-Version: 2.1
Name: hvas
Version: {version}
Summary: Haptic virtual assembly: feel an assembly before anyone cuts metal
License: Apache-2.0
Requires-Python: ==3.11.*
Requires-Dist: numpy
"""
WHEEL = f"Wheel-Version: 1.0\nGenerator: hvas\nRoot-Is-Purelib: false\nTag: {TAG}\n"
LONG_AGO = (1980, 1, 1, 0, 0, 0)


def collect(build):
    """Files of the wheel by their path in it: (bytes, mode)."""
    files = {}
    with tempfile.TemporaryDirectory() as folder:
        for component in ("runtime", "python"):
            subprocess.run(["cmake", "--install", build, "--prefix", folder, "--component", component, "--strip"],
                           check=True, stdout=subprocess.DEVNULL)
        root = pathlib.Path(folder)
        for file in sorted((root / "lib/python3/dist-packages/hvas").iterdir()):
            files[f"hvas/{file.name}"] = (file.read_bytes(), 0o755 if file.suffix == ".so" else 0o644)
        library = next(root.glob("lib*/**/libhvas.so.?"))
        files[f"hvas/{library.name}"] = (library.read_bytes(), 0o755)
        files["hvas/bin/hvas-cad"] = ((root / "bin/hvas-cad").read_bytes(), 0o755)
    return files


def main():
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    build, folder = map(pathlib.Path, sys.argv[1:])
    version = re.search(r"CMAKE_PROJECT_VERSION:STATIC=(.+)", (build / "CMakeCache.txt").read_text()).group(1)
    files = collect(build)
    info = f"hvas-{version}.dist-info"
    files[f"{info}/METADATA"] = (METADATA.format(version=version).encode(), 0o644)
    files[f"{info}/WHEEL"] = (WHEEL.encode(), 0o644)
    record = ""
    for name, (data, _) in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        record += f"{name},sha256={digest},{len(data)}\n"
    files[f"{info}/RECORD"] = (f"{record}{info}/RECORD,,\n".encode(), 0o644)
    folder.mkdir(parents=True, exist_ok=True)
    wheel = folder / f"hvas-{version}-{TAG}.whl"
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, (data, mode) in files.items():
            entry = zipfile.ZipInfo(name, LONG_AGO)
            entry.external_attr = (0o100000 | mode) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, data)
    print(wheel)
    return 0


if __name__ == "__main__":
    sys.exit(main())
