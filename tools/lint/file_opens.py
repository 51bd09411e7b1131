#!/usr/bin/env python3
"""Checks that files are opened by the one door of base/regular_file.h.

A name that a user gives can be that of a pipe, which opening waits for, of a device, which has no end, or of a folder. The
sources open files with ReadRegularFile() and its neighbours, or call CheckRegularFile() before a library opens the name; for
writing there are WriteAtomically() and OpenLocked(). All other calls that open a file are listed here with the reason.
Looked at in src/ and python/src/, but for tests. Prints each line that offends; exit status 1 when there is one, or when
an entry of the list is of no use.
"""

import re
import sys

from checkout import list_sources, parse_root, report

OPEN = re.compile(
    r"\bstd::(?:basic_)?[io]?fstream\b|\bstd::filebuf\b|\b(?:std::|::)?f(?:re)?open(?:64)?\s*\(|::open(?:at2?|64)?\s*\(|\bcreat\s*\("
    r"|\bsqlite3_open\w*\s*\(|\bdlopen\s*\(|\bBIO_new_file\s*\(|\bgzopen\w*\s*\(|\buse_(?:certificate|private_key)\w*_file\s*\("
    r"|\bcopy_file\s*\("
)

# The file, and how it is that no user's pipe is waited for.
ALLOWED = {
    "src/base/regular_file.cc": "it is the door",
    "src/base/file_lock.cc": "OpenLocked() refuses what is no regular file, and does not wait",
    "src/base/file_cache.cc": "makes files of its own, with O_TMPFILE or O_EXCL",
    "src/base/scratch_folder.cc": "opens a folder, with O_DIRECTORY and O_NOFOLLOW",
    "src/base/served_process.cc": "writes to /proc/self",
    "src/base/work_watch.cc": "reads /proc/self",
    "src/app/devices/doctor_checks.cc": "reads /proc and /sys",
    "src/app/recording/page_file.cc": "copies what was printed into a folder of its own",
    "src/cad/export_step.cc": "writes into a scratch folder",
    "src/device/drivers/dynamic_library.cc": "loads what CheckRegularFile() has passed, and libraries of the system",
    "src/device/drivers/evdev_node.cc": "opens a device of the kernel, with O_NONBLOCK",
    "src/device/drivers/gamepad.cc": "reads /sys",
    "src/device/drivers/plugin.cc": "loads what CheckRegularFile() has passed",
    "src/device/drivers/usb_nodes.cc": "reads /sys",
    "src/device/emulation/plugin_emulator.cc": "loads a library of the build",
    "src/device/emulation/spacenav_server.cc": "writes into the emulator's folder",
    "src/evidence/output_file.h": "writes a file that output_file.cc has made sure to be new",
    "src/record/database.cc": "callers check the name; it copies what SQLite has opened",
    "src/record/write_claim.cc": "opens with O_NONBLOCK what is a record, or makes it with O_EXCL",
    "src/simulation/realtime_thread.cc": "reads /sys",
    "src/studio/audit_log.cc": "opens a file of the user's own state folder, with O_NOFOLLOW",
    "src/studio/state_folder.cc": "opens files of the user's own state folder, with O_NOFOLLOW",
    "src/studio/upload_file.cc": "makes a file of its own, with O_EXCL",
    "src/studio/tls.cc": "files that CheckRegularFile() has passed",
}


def find_opens(text):
    """Number and text of each line that opens a file by itself."""
    within = False
    for number, line in enumerate(text.splitlines(), 1):
        code = re.sub(r'"(?:\\.|[^"\\])*"', '""', line).split("//")[0]
        if "/*" in code:
            within, code = "*/" not in code, code.split("/*")[0]
        elif within:
            within, code = "*/" not in code, ""
        if OPEN.search(code):
            yield number, line.strip()


def check(root):
    problems, used = [], set()
    paths = [*list_sources(root), *sorted((root / "python/src").glob("*.cc"))]
    for path in paths:
        name = str(path.relative_to(root))
        opens = list(find_opens(path.read_text()))
        if opens and name in ALLOWED:
            used.add(name)
        else:
            problems += [f"{name}:{line}: opens a file beside base/regular_file.h: {text}" for line, text in opens]
    problems += [f"{name}: opens no file, and needs no entry in tools/lint/file_opens.py" for name in sorted(ALLOWED.keys() - used)]
    return problems


def main():
    return report(check(parse_root(__doc__)), f"opened files: {len(ALLOWED)} sources beside base/regular_file.h, each with its reason")


if __name__ == "__main__":
    sys.exit(main())
