#!/usr/bin/env python3
"""Checks how the sources are laid out: check_structure.py ROOT. Prints every breach; exits 1 where there is one."""

import os
import re
import sys

# The headers that are installed, which are included as "adamas/...": all modules may include them, and they only each other
# and those of the standard library.
PUBLIC = "include/adamas"
# Installed headers that convert to the types of a library, for those who have it. Such a header may include
# that library, and our own files may include it where they may include the library.
PUBLIC_CONVERSIONS = {"include/adamas/openmesh.h": r"OpenMesh/.*"}
# The modules that each module may include, besides itself. A file belongs to the longest name that its path
# begins with.
MAY_INCLUDE = {
    "core": [],
    "core/io": ["core"],
    "core/picture": ["core"],
    "interfaces": ["core"],
    "isosurface": ["core"],
    "timevarying": ["core", "isosurface"],
    "datasets": ["core"],
    "workflow": ["core", "core/io", "core/picture", "interfaces", "isosurface", "timevarying", "datasets"],
    "viewer": ["core", "core/io", "core/picture", "interfaces", "isosurface", "timevarying"],
    "cli": [],
    "tests": ["core", "core/io", "core/picture", "interfaces", "isosurface", "timevarying", "datasets", "workflow", "viewer", "cli"],
}
# The folders of each module in order: a folder may include those before it.
FOLDER_ORDER = {
    "core": ["base", "geometry", "distance", "lattice", "data"],
    "interfaces": ["ownership", "network", "reconstruction", "mesh_reconstruction", "fields", "input", "hierarchy", "mesh", "cell_errors", "resampling", "selection",
                   "probe", "cross_section", "cutting", "simplification", "api", "reference_client", "comparison",
                   "reference_program"],
    "isosurface": ["volume", "preprocessing", "gradients", "compression", "storage", "contour", "extraction", "view"],
    "workflow": ["input", "output", "slices", "stores", "series", "experiments"],
    "viewer": ["contents", "session", "gl", "window", "api"],
}
# Headers that only some modules may include, most of them heavy ones. Of our headers, only those that .cpp
# files of the same folder alone include may include them.
OWNED = {
    r"vtk\w*\.h": ["core/io", "tests"],
    r"cairo[\w-]*\.h|cairo/.*": ["core/picture", "tests"],
    r"tbb/.*|oneapi/tbb.*": ["core"],
    r"silo\.h": ["core/io", "tests"],
    r"CGAL/.*": ["core/io", "interfaces", "tests"],
    r"Eigen/.*": ["interfaces", "tests"],
    r"OpenMesh/.*|adamas/openmesh\.h": ["interfaces", "tests"],
    r"tiffio\.h|zlib\.h|bzlib\.h|png\.h|hdf5\.h|expat\.h": ["core/io", "tests"],
    r"epoxy/.*|GL/.*|GLFW/.*|EGL/.*|imgui.*": ["viewer", "tests"],
    r"CLI/.*": ["cli", "tests"],
    r"nlohmann/.*": ["core/io", "workflow", "viewer", "cli", "tests"],
}
LIGHT = [r"CLI/.*", r"nlohmann/.*"]
# Headers that take seconds to compile, with the only files of the program that may include them.
SLOW = {r"CLI/.*": ["cli/command.cpp", "cli/command_line.cpp", "cli/config_file.cpp", "cli/help.cpp"]}
# Our headers that convert to the types of a library: .cpp files of every folder may include them.
CONVERSIONS = ["interfaces/simplification/openmesh_patches.h"]
FOLDERS = ["include", "core", "interfaces", "isosurface", "timevarying", "datasets", "workflow", "viewer", "cli", "tests", "scripts", "cmake", "docs", ".ci"]
ROOT_FILES = ["CMakeLists.txt", "CMakePresets.json", "README.md", "CONTRIBUTING.md", "CHANGELOG.md", ".clang-format", ".clang-tidy"]
LIBRARY_PAGE = "docs/library.md"
NO_TEXT = {".png", ".vtr", ".vti", ".vtu", ".vtp", ".gz", ".tif", ".nrrd", ".bin"}
CODE = {".h", ".cpp"}
# Documents that are not part of the repository; docs/ has what they say.
UNKNOWN_DOCUMENT = re.compile(r"\b(SPEC|TARGETS|DESIGN)\b")
ABSOLUTE_PATH = re.compile(r"""(?<![\w.$}/-])/(work|home|root|Users|mnt)/[\w.]""")
CONFLICT = re.compile(r"<{7} |>{7} ")
TEST = re.compile(r"^(TEST|TEST_F|TEST_P|TYPED_TEST)\(", re.MULTILINE)
# The namespace of each module, below adamas. That of core is an inline one, so all other modules see its
# names as their own.
NAMESPACES = {"core": "inline core", "core/io": "io", "core/picture": "picture", "interfaces": "interfaces", "isosurface": "isosurface",
              "timevarying": "timevarying", "datasets": "datasets", "workflow": "workflow", "viewer": "viewer", "cli": "cli"}
NAMESPACE = re.compile(r"^namespace (adamas[\w: ]*) \{", re.MULTILINE)
TYPE = re.compile(r"^(?:class|struct|enum class|enum|union) (\w+)\b(?!;|::|<)", re.MULTILINE)
UNNAMED = re.compile(r"^namespace \{\n.*?^\}  // namespace\n", re.MULTILINE | re.DOTALL)
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def module_of(path):
    names = [name for name in MAY_INCLUDE if path.startswith(name + "/")]
    return max(names, key=len, default=None)


def sources(root):
    for folder in FOLDERS:
        for base, folders, files in os.walk(os.path.join(root, folder)):
            folders[:] = sorted(f for f in folders if f not in ("corpus", "golden", "__pycache__"))
            for name in sorted(files):
                yield os.path.relpath(os.path.join(base, name), root)
    for name in ROOT_FILES:
        if os.path.exists(os.path.join(root, name)):
            yield name


def check_public_header(root, path, quote, target):
    if re.fullmatch(PUBLIC_CONVERSIONS.get(path, r"(?!)"), target):
        return
    if os.path.join("include", target) in PUBLIC_CONVERSIONS:
        yield f"includes {target}, which is for those who have what it converts to"
        return
    of_standard_library = quote == "<" and re.fullmatch(r"[a-z_]+", target)
    if not of_standard_library and not (quote == '"' and os.path.exists(os.path.join(root, "include", target))):
        yield f"includes {target}: installed headers include each other and the standard library alone"


def components(root):
    """The module behind each installed header, by the HEADERS of the CMake files."""
    found = {}
    for path in sources(root):
        if os.path.basename(path) == "CMakeLists.txt" and module_of(path):
            with open(os.path.join(root, path), encoding="utf-8") as file:
                for headers in re.findall(r"adamas_library\(.* HEADERS ([^)]*)\)", file.read().replace("\n", " ")):
                    found.update({name: module_of(path) for name in headers.split() if name.endswith(".h")})
    return found


def check_components(root):
    """Components are installed one by one: their headers include those of the components that they stand on."""
    behind = components(root)
    for name, here in behind.items():
        with open(os.path.join(root, PUBLIC, name), encoding="utf-8") as file:
            for target in re.findall(r'#include "adamas/([^"]+)"', file.read()):
                there = behind.get(target)
                if there != here and there not in MAY_INCLUDE[here]:
                    yield f"{PUBLIC}/{name}: includes adamas/{target}, which is of {there}: {here} may not use it"


def check_project_include(root, path, target):
    if os.path.exists(os.path.join(root, "include", target)):
        return
    if not any(os.path.exists(os.path.join(root, target + end)) for end in ("", ".in")):
        # Tests and fuzz targets may include what lies beside them.
        beside = os.path.join(os.path.dirname(path), target)
        if path.startswith("tests/") and os.path.exists(os.path.join(root, beside)):
            return
        yield f"includes \"{target}\", which is no file of the project (paths are from the root)"
        return
    here, there = module_of(path), module_of(target)
    if here is None or there is None:
        yield f"includes \"{target}\" across unknown modules"
    elif there != here and there not in MAY_INCLUDE[here]:
        yield f"includes \"{target}\": {here} may not use {there}"
    elif here == there and here in FOLDER_ORDER:
        order, folder, other = FOLDER_ORDER[here], path.split("/")[1], target.split("/")[1]
        if folder not in order:
            yield f"lies in {here}/{folder}, which has no place in the order of {here}'s folders"
        elif other not in order[: order.index(folder) + 1]:
            yield f"includes \"{target}\": {here}/{folder} lies below {here}/{other}"


def check_heavy_header(root, path, target):
    for other in sources(root):
        if os.path.splitext(other)[1] not in CODE or other == path:
            continue
        with open(os.path.join(root, other), encoding="utf-8", errors="replace") as file:
            if f'#include "{path}"' not in file.read():
                continue
        elsewhere = os.path.dirname(other) != os.path.dirname(path) and path not in CONVERSIONS
        if other.endswith(".h") or elsewhere:
            yield f"includes <{target}>, and {other} includes it: such headers are for .cpp files of their own folder"


def check_code(root, path, text):
    is_header = path.endswith(".h")
    if is_header and not text.startswith("#pragma once\n"):
        yield "does not begin with #pragma once"
    if path.startswith("tests/") and bool(TEST.search(text)) != path.endswith("_test.cpp"):
        yield "files with tests, and no others, have names that end in _test.cpp"
    for quote, target in INCLUDE.findall(text):
        if path.startswith(PUBLIC):
            yield from check_public_header(root, path, quote, target)
            continue
        for pattern, modules in OWNED.items():
            if not re.fullmatch(pattern, target):
                continue
            if is_header and pattern not in LIGHT:
                yield from check_heavy_header(root, path, target)
            if module_of(path) not in modules:
                yield f"includes <{target}>, which is for {', '.join(modules)}"
        for pattern, files in SLOW.items():
            if re.fullmatch(pattern, target) and not path.startswith("tests/") and path not in files:
                yield f"includes <{target}>, which is for {', '.join(files)}"
        if quote == '"':
            yield from check_project_include(root, path, target)


def check_namespaces(path, text):
    """A module's names are in its namespace; what include/adamas declares, and .cpp files define, is in adamas."""
    wanted = "adamas::" + NAMESPACES[module_of(path)]
    for found in NAMESPACE.findall(text):
        if found == wanted or found.startswith(wanted + "::"):
            continue
        forward = re.search(rf"^namespace {found} \{{\n((class|struct) \w+;\n)+\}}", text, re.MULTILINE)
        if not forward and not (found == "adamas" and (path.endswith(".cpp") or "/api/" in path)):
            yield f"has namespace {found}, and its module's is {wanted}"


def check_names(types):
    """`types`: of each name of a type the files that define it."""
    for name, paths in sorted(types.items()):
        if len(paths) > 1:
            yield f"{paths[1]}: defines {name}, which {paths[0]} defines too"


def check_text(path, text):
    lines = text.split("\n")
    if text and not text.endswith("\n"):
        yield "does not end with a newline"
    for number, line in enumerate(lines, 1):
        if line != line.rstrip():
            yield f"line {number} ends in whitespace"
        if "\t" in line:
            yield f"line {number} has a tab"
        if CONFLICT.match(line):
            yield f"line {number} is of a merge that was not finished"
        if ABSOLUTE_PATH.search(line):
            yield f"line {number} has an absolute path"
        document = UNKNOWN_DOCUMENT.search(line)
        if document and os.path.splitext(path)[1] in CODE | {".md"}:
            yield f"line {number} cites {document.group()}, which is no document of the repository"


def check_examples(root):
    """The library's page shows parts of the consumer programs, which the tests build and run."""
    folder = os.path.join(root, "tests", "install_consumer", "consumer")
    if not os.path.exists(os.path.join(root, LIBRARY_PAGE)):
        return
    programs = []
    for name in sorted(os.listdir(folder)):
        with open(os.path.join(folder, name), encoding="utf-8") as file:
            programs.append("".join(file.read().split()))
    with open(os.path.join(root, LIBRARY_PAGE), encoding="utf-8") as file:
        for example in re.findall(r"```cpp\n(.*?)```", file.read(), re.DOTALL):
            if not any("".join(example.split()) in program for program in programs):
                yield f"{LIBRARY_PAGE}: the example that begins with '{example.split(chr(10))[0]}' is in no consumer program"


def breaches(root):
    """All breaches as lines of text."""
    types = {}
    for path in sources(root):
        extension = os.path.splitext(path)[1]
        if extension in NO_TEXT:
            continue
        try:
            with open(os.path.join(root, path), encoding="utf-8", newline="") as file:
                text = file.read()
        except UnicodeDecodeError:
            yield f"{path}: is no UTF-8 text"
            continue
        found = list(check_text(path, text))
        if extension in CODE and (module_of(path) or path.startswith(PUBLIC)):
            found += check_code(root, path, text)
            if not path.startswith("tests/"):
                if module_of(path):
                    found += check_namespaces(path, text)
                for name in TYPE.findall(UNNAMED.sub("", text)):
                    types.setdefault(name, []).append(path)
        for breach in found:
            yield f"{path}: {breach}"
    yield from check_names(types)
    yield from check_examples(root)
    yield from check_components(root)
    for module in MAY_INCLUDE:
        if os.path.isdir(os.path.join(root, module)) and not os.path.exists(os.path.join(root, module, "README.md")):
            yield f"{module}: has no README.md"


def main():
    found = list(breaches(sys.argv[1]))
    for breach in found:
        print(breach)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
