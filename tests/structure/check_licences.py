#!/usr/bin/env python3
"""Checks that no source of the program or of a library that is installed includes a header under the GPL or the AGPL:
check_licences.py NINJA BUILD_FOLDER TARGET... looks at all objects of the targets that have been built, and there have to be
some. Prints every breach; exits 1 where there is one. The LGPL, and the GPL with an exception for those who include a
header, are no breach."""

import functools
import re
import subprocess
import sys

# Licences are at the beginning of a file.
HEAD_BYTES = 8192
IDENTIFIER = re.compile(r"SPDX-License-Identifier:\s*(.+)")
STRICT = re.compile(r"\bA?GPL\b")
NAMED = re.compile(r"GNU\s+(?:Affero\s+)?General\s+Public\s+License")
MILDER = re.compile(r"Lesser|Library\s+General|(?:Library|special|linking)\s+[Ee]xception|License\s+Exception")


def strict_licence(text):
    """The words that put a file with this beginning under the GPL or AGPL; none where it is under another licence."""
    # Comments are broken into lines.
    plain = re.sub(r"\n[\s/*#]*", " ", text)
    identifier = IDENTIFIER.search(text)
    if identifier:
        words = identifier.group(1).strip().rstrip("*/ ")
        # One of several licences may be chosen, but a commercial one has to be bought.
        choices = [c for c in re.split(r"\s+OR\s+", words) if "Commercial" not in c]
        strict = all(STRICT.search(c) and " WITH " not in c for c in choices)
        return words if strict else None
    named = NAMED.search(plain)
    return named.group() if named and not MILDER.search(plain) else None


@functools.lru_cache(maxsize=None)
def strict_licence_of(path):
    with open(path, encoding="utf-8", errors="replace") as file:
        return strict_licence(file.read(HEAD_BYTES))


def dependencies(ninja, build_folder):
    """For each object that has been built, the files it was made from."""
    listing = subprocess.run([ninja, "-C", build_folder, "-t", "deps"], check=True, capture_output=True, text=True).stdout
    found, current = {}, None
    for line in listing.splitlines():
        if line.startswith("    "):
            current.append(line.strip())
        elif ": #deps" in line:
            current = found.setdefault(line.split(": #deps")[0], [])
    return found


def breaches(found, targets):
    """All breaches as lines of text: of the objects of these targets, given the files each is made from."""
    for target in targets:
        objects = [name for name in sorted(found) if f"CMakeFiles/{target}.dir/" in name]
        if not objects:
            yield f"{target}: nothing of it has been built"
        for name in objects:
            for path in found[name]:
                licence = strict_licence_of(path) if path.startswith("/") else None
                if licence:
                    yield f"{name}: includes {path}, which is under {licence}"


def main():
    ninja, build_folder, *targets = sys.argv[1:]
    found = list(breaches(dependencies(ninja, build_folder), targets))
    for breach in found:
        print(breach)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
