#!/usr/bin/env python3
"""Makes the Debian packages and the wheel of a build, and uses them where nothing else of HVAS is:

    packages_test.py SOURCES BUILD COMPILER
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

SCRIPT = """import sys, hvas
outcome = hvas.prepare(hvas.open(sys.argv[1], cache=False), cache=False).assemble()
print(len(outcome.parts), outcome.complete, outcome.digest)
"""


def run(*command, **options):
    result = subprocess.run([str(word) for word in command], text=True, capture_output=True, **options)
    if result.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\nended with {result.returncode}:\n{result.stdout}{result.stderr}")
    return result.stdout


def refuse(*command, **options):
    """What a program prints that ends with status 1."""
    result = subprocess.run([str(word) for word in command], text=True, capture_output=True, **options)
    if result.returncode != 1:
        sys.exit(f"{' '.join(map(str, command))}\nended with {result.returncode}:\n{result.stdout}{result.stderr}")
    return result.stdout + result.stderr


def expect(text, part):
    if part not in text:
        sys.exit(f"this has no {part!r}:\n{text}")
    print(f"ok: {part}")


def main():
    sources, build, compiler = map(pathlib.Path, sys.argv[1:])
    # What is built where is not to be found: neither the build's hvas-cad nor its library.
    environment = {"PATH": "/usr/bin:/bin", "HOME": "/nonexistent", "PYTHONDONTWRITEBYTECODE": "1"}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run("cpack", "-B", folder / "made", "--config", build / "CPackConfig.cmake", cwd=folder)
        packages = {file.name.split("_")[0]: file for file in folder.glob("**/*.deb")}
        if set(packages) != {"hvas", "hvas-dev", "python3-hvas"}:
            sys.exit(f"made {sorted(packages)}")
        for package in packages.values():
            run("dpkg-deb", "-x", package, folder / "root")
        root = folder / "root/usr"
        expect(run("dpkg-deb", "-f", packages["hvas"], "Depends"), "libocct-data-exchange-7.6")
        product = root / "share/hvas/products/bushing.step"
        digest = run(root / "bin/hvas", "assemble", product, "--quiet", "--no-cache", env=environment)
        expect(digest, "digest 843a85d5bc4c76e4176ead5c0adc7136")
        for file in ("share/man/man1/hvas.1", "share/bash-completion/completions/hvas", "share/hvas/schemas/plan.schema.json"):
            expect("\n".join(str(path) for path in root.rglob("*")), file)

        stranger = folder / "stranger"
        stranger.mkdir()
        page = (sources / "docs/cpp.md").read_text()
        for file, language in (("CMakeLists.txt", "cmake"), ("mine.cc", "c++")):
            (stranger / file).write_text(page.split(f"```{language}\n")[1].split("```")[0])
        run("cmake", "-S", stranger, "-B", stranger / "build", f"-DCMAKE_PREFIX_PATH={root}", f"-DCMAKE_CXX_COMPILER={compiler}")
        run("cmake", "--build", stranger / "build")
        expect(run(stranger / "build/mine", product, env=environment), "3 parts")
        for arguments in ([], [product, product]):
            expect(refuse(stranger / "build/mine", *arguments, env=environment), "usage: mine FILE")

        python = {**environment, "PYTHONPATH": str(root / "lib/python3/dist-packages")}
        expect(run("/usr/bin/python3", "-c", SCRIPT, product, env=python), "True 843a85d5bc4c76e4176ead5c0adc7136")

        wheel = run(sys.executable, sources / "python/make_wheel.py", build, folder / "wheel").strip()
        shutil.unpack_archive(wheel, folder / "site", "zip")
        os.chmod(folder / "site/hvas/bin/hvas-cad", 0o755)  # Unpacking forgets it; pip does not.
        shutil.copy(product, folder / "bushing.step")
        shutil.copy(product.with_suffix(".hvas.json"), folder / "bushing.hvas.json")
        shutil.rmtree(folder / "root")
        python["PYTHONPATH"] = str(folder / "site")
        expect(run("/usr/bin/python3", "-c", SCRIPT, folder / "bushing.step", env=python), "True 843a85d5bc4c76e4176ead5c0adc7136")


if __name__ == "__main__":
    main()
