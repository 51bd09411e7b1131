#!/usr/bin/env python3
"""Compiles each header by itself: headers_test.py COMPILER GENERATED SOURCES EIGEN HEADER..."""

import concurrent.futures
import os
import subprocess
import sys


def main():
    compiler, *folders, = sys.argv[1:5]
    headers = sys.argv[5:]
    includes = [flag for folder in folders for flag in ("-isystem" if folder == folders[-1] else "-I", folder)]

    def check(header):
        run = subprocess.run([compiler, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", *includes, "-x", "c++", "-"],
                             input=f'#include "{header}"\n', text=True, capture_output=True)
        return header, run.stderr if run.returncode else ""

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        failed = [(header, text) for header, text in pool.map(check, headers) if text]
    for header, text in failed:
        print(f"{header} does not compile by itself:\n{text}")
    print(f"{len(headers) - len(failed)} of {len(headers)} headers compile by themselves")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
