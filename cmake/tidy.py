#!/usr/bin/env python3
"""Runs clang-tidy over every source of the project, two at a time, and prints only what it finds.

A file that was clean is not looked at again until it, a project header it includes, its flags or the checks change:
the stamps lie in ~/.cache/astroid-tidy and hold for every checkout on the machine. `--all` ignores them.
`--deep` adds the path-sensitive analyzer, which takes some five times longer; continuous integration does without.
usage: cmake/tidy.py [--all] [--deep] [--jobs N] [PART_OF_A_PATH...]
"""

import argparse
import concurrent.futures
import functools
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / "build" / "tidy"
TIDY = "clang-tidy-14"
DEEP_CHECKS = "clang-analyzer-*,-clang-analyzer-security.FloatLoopCounter,-clang-analyzer-security.insecureAPI.*"
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)
STAMPS = pathlib.Path(os.environ.get("XDG_CACHE_HOME", pathlib.Path.home() / ".cache")) / "astroid-tidy"


def configure():
    """Writes build/tidy/compile_commands.json: no ccache, no precompiled headers, which clang cannot read from g++."""
    done = subprocess.run(["cmake", "--preset", "tidy"], cwd=ROOT, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stdout + done.stderr)
    return json.loads((BUILD / "compile_commands.json").read_text())


def project_entries(commands, parts):
    """The commands of the project's own sources; the stubs that CMake generates to verify headers lie in build/."""
    for entry in commands:
        path = pathlib.Path(entry["file"])
        if path.is_relative_to(ROOT) and not path.is_relative_to(ROOT / "build"):
            relative = str(path.relative_to(ROOT))
            if not parts or any(part in relative for part in parts):
                yield entry


@functools.cache
def quoted_includes(path):
    return INCLUDE.findall(path.read_text(errors="replace"))


def headers_of(entry):
    """The project's files that a source may include, itself among them, as quoted includes say, whatever #if says."""
    folders = [pathlib.Path(word[2:]) for word in shlex.split(entry["command"]) if word.startswith("-I")]
    found, waiting = set(), [pathlib.Path(entry["file"])]
    while waiting:
        path = waiting.pop()
        if path in found:
            continue
        found.add(path)
        for name in quoted_includes(path):
            waiting += [candidate for candidate in ((folder / name).resolve() for folder in (path.parent, *folders))
                        if candidate.is_relative_to(ROOT) and candidate.is_file()]
    return sorted(found)


def stamp_of(entry, common):
    digest = hashlib.sha256(common)
    digest.update(entry["command"].replace(str(ROOT), "").encode())
    for path in headers_of(entry):
        digest.update(str(path.relative_to(ROOT)).encode() + b"\0" + path.read_bytes())
    return STAMPS / digest.hexdigest()


def check(entry, common, command, ignore_stamps):
    """Returns what clang-tidy says of one source, '' when it has nothing to say."""
    stamp = stamp_of(entry, common)
    if stamp.exists() and not ignore_stamps:
        stamp.touch()
        return ""
    done = subprocess.run([*command, entry["file"]], cwd=ROOT, capture_output=True, text=True)
    if done.returncode != 0 or done.stdout.strip():
        return done.stdout + (done.stderr if not done.stdout.strip() else "")
    stamp.touch()
    return ""


def forget_old_stamps(days=30):
    for stamp in STAMPS.iterdir():
        if stamp.stat().st_mtime < time.time() - days * 86400:
            stamp.unlink(missing_ok=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--all", action="store_true", help="look at clean files again")
    parser.add_argument("--deep", action="store_true", help="with the path-sensitive analyzer")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("parts", nargs="*", help="only files whose path contains one of these")
    options = parser.parse_args()

    version = subprocess.run([TIDY, "--version"], capture_output=True, text=True, check=True).stdout
    command = [TIDY, "-p", str(BUILD), "--quiet"] + ([f"--checks={DEEP_CHECKS}"] if options.deep else [])
    settings = b"".join((ROOT / folder / ".clang-tidy").read_bytes() for folder in (".", "tests"))
    common = settings + version.encode() + (DEEP_CHECKS.encode() if options.deep else b"")
    STAMPS.mkdir(parents=True, exist_ok=True)
    forget_old_stamps()
    entries = list(project_entries(configure(), options.parts))
    if not entries:
        sys.exit("clang-tidy: no source to look at")
    bad = 0
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for findings in pool.map(lambda entry: check(entry, common, command, options.all), entries):
            if findings:
                bad += 1
                print(findings, flush=True)
    print(f"clang-tidy: {len(entries)} sources, {bad} with findings")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
