"""python -m hvas: the program hvas, or what a file has in it where only the package is installed."""

import argparse
import os
import shutil
import sys

import hvas


def main():
    program = shutil.which("hvas")
    if program and sys.argv[1:] and sys.argv[1] != "info":
        os.execv(program, [program, *sys.argv[1:]])
    parser = argparse.ArgumentParser(
        prog="python -m hvas", description="Shows what a CAD file has in it; all other commands are the program's, where it is installed.",
        epilog="Example: python -m hvas info products/gear_pump.step")
    parser.add_argument("command", choices=["info"])
    parser.add_argument("file")
    arguments = parser.parse_args()
    try:
        product = hvas.open(arguments.file)
    except hvas.Error as error:
        print(error, file=sys.stderr)
        return 1
    print(f"{product.source}: {len(product.occurrences)} parts, {len(product.mates)} mates, {product.mass:.3f} kg")
    for mate in product.mates:
        names = [product.occurrences[i].path for i in (mate.a, mate.b)]
        fit = f", {1e3 * mate.fit.nominal:.3g} mm {mate.fit.code or mate.fit.kind}" if mate.fit else ""
        print(f"  {mate.kind}: {names[0]} <- {names[1]}{fit}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
