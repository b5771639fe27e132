#!/usr/bin/env python3
"""Breaks each rule of check_structure.py and check_licences.py in small files of its own and expects it to be found."""

import os
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import check_licences  # noqa: E402
from check_structure import breaches  # noqa: E402

SOUND = {
    "core/README.md": "# core\n",
    "core/base/error.h": "#pragma once\n",
    "core/data/grid.h": '#pragma once\n#include "core/base/error.h"\n',
    "core/io/README.md": "# io\n",
    "core/io/reader.h": "#pragma once\n",
    "core/io/reader.cpp": '#include <vtkImageData.h>\n#include "core/io/reader.h"\n#include "core/data/grid.h"\n',
    "core/picture/README.md": "# picture\n",
    "core/picture/canvas.h": "#pragma once\n",
    "interfaces/README.md": "# interfaces\n",
    "interfaces/source.h": '#pragma once\n#include "core/data/grid.h"\n',
}


class StructureTest(unittest.TestCase):
    def expect(self, files, expected):
        with tempfile.TemporaryDirectory() as root:
            for path, text in {**SOUND, **files}.items():
                if text is None:
                    continue
                os.makedirs(os.path.dirname(os.path.join(root, path)), exist_ok=True)
                with open(os.path.join(root, path), "w", encoding="utf-8", newline="") as file:
                    file.write(text)
            found = list(breaches(root))
        self.assertEqual(len(found), 1 if expected else 0, found)
        if expected:
            self.assertIn(expected, found[0])

    def test_sound_tree_has_none(self):
        self.expect({}, None)

    def test_include_directions(self):
        self.expect({"core/data/a.h": '#pragma once\n#include "interfaces/source.h"\n'}, "core may not use interfaces")
        self.expect({"core/data/a.h": '#pragma once\n#include "core/io/reader.h"\n'}, "core may not use core/io")
        self.expect({"core/io/a.h": '#pragma once\n#include "core/picture/canvas.h"\n'}, "may not use core/picture")
        self.expect({"core/base/a.h": '#pragma once\n#include "core/data/grid.h"\n'}, "below core/data")
        self.expect({"interfaces/a.h": '#pragma once\n#include "source.h"\n'}, "no file of the project")

    def test_components(self):
        headers = {"include/adamas/volume.h": "#pragma once\n", "include/adamas/series.h": '#pragma once\n#include "adamas/volume.h"\n'}
        here = {"core/CMakeLists.txt": "adamas_library(core . HEADERS volume.h)\n",
                "core/io/CMakeLists.txt": "adamas_library(io .\n  HEADERS series.h)\n"}
        self.expect({**headers, **here}, None)
        turned = {path: text.replace("volume.h", "?").replace("series.h", "volume.h").replace("?", "series.h") for path, text in here.items()}
        self.expect({**headers, **turned}, "series.h: includes adamas/volume.h, which is of core/io: core may not use it")

    def test_installed_headers(self):
        public = {"include/adamas/volume.h": "#pragma once\n#include <vector>\n"}
        include = '#pragma once\n#include "adamas/volume.h"\n'
        self.expect({**public, "core/data/a.h": include, "include/adamas/store.h": include}, None)
        self.expect({"include/adamas/volume.h": '#pragma once\n#include "core/base/error.h"\n'}, "each other")
        self.expect({"include/adamas/volume.h": "#pragma once\n#include <fmt/format.h>\n"}, "each other")
        # Only one header converts to the types of a library; no other header may include that library or this
        # header.
        openmesh = {"include/adamas/openmesh.h": "#pragma once\n#include <OpenMesh/Core/Mesh/Handles.hh>\n"}
        self.expect(openmesh, None)
        self.expect({"include/adamas/volume.h": "#pragma once\n#include <OpenMesh/Core/Mesh/Handles.hh>\n"}, "each other")
        self.expect({**openmesh, "include/adamas/volume.h": '#pragma once\n#include "adamas/openmesh.h"\n'}, "for those who have")
        self.expect({**openmesh, "core/data/a.cpp": '#include "adamas/openmesh.h"\n'}, "which is for interfaces")
        self.expect({"core/data/a.h": include}, "no file of the project")

    def test_examples(self):
        page = {"docs/library.md": "```cpp\nf(1);\n```\n"}
        program = "tests/install_consumer/consumer/a.cpp"
        readme = {"tests/README.md": "# tests\n"}
        self.expect({**page, **readme, program: "int main() {\n  f(1);\n}\n"}, None)
        self.expect({**page, **readme, program: "int main() {\n  f(2);\n}\n"}, "begins with 'f(1);'")

    def test_namespaces(self):
        def within(name, inside="class A {};"):
            return f"#pragma once\nnamespace {name} {{\n{inside}\n}}  // namespace {name}\n"

        self.expect({"interfaces/a.h": within("adamas::interfaces"), "core/base/a.h": within("adamas::inline core", "class B {};")}, None)
        self.expect({"interfaces/a.h": within("adamas")}, "has namespace adamas, and its module's is adamas::interfaces")
        self.expect({"interfaces/a.h": within("adamas::io", "class A;")}, None)
        self.expect({"interfaces/a.cpp": "namespace adamas {\nint f() { return 1; }\n}\n"}, None)

    def test_names_of_types(self):
        text = "#pragma once\nnamespace adamas::interfaces {\nstruct A {\n};\n}  // namespace adamas::interfaces\n"
        self.expect({"interfaces/a.h": text, "core/io/a.h": text.replace("interfaces", "io")}, "defines A, which core/io/a.h defines too")
        self.expect({"interfaces/a.h": text, "core/io/a.h": "#pragma once\nnamespace adamas::io {\nstruct A;\n}\n"}, None)
        hidden = "namespace adamas::io {\nnamespace {\nstruct A {\n};\n}  // namespace\n}\n"
        self.expect({"interfaces/a.h": text, "core/io/a.cpp": hidden}, None)

    def test_order_of_folders(self):
        mesh = {"interfaces/mesh/mesh.h": "#pragma once\n"}
        include = '#pragma once\n#include "interfaces/mesh/mesh.h"\n'
        self.expect({**mesh, "interfaces/resampling/a.h": include}, None)
        self.expect({**mesh, "interfaces/network/a.h": include}, "interfaces/network lies below interfaces/mesh")
        self.expect({**mesh, "interfaces/elsewhere/a.h": include}, "no place in the order of interfaces's folders")

    def test_names_of_tests(self):
        readme = {"tests/README.md": "# tests\n"}
        self.expect({**readme, "tests/core/a_test.cpp": "TEST(A, B) {}\n", "tests/core/b.cpp": "int b;\n"}, None)
        self.expect({**readme, "tests/core/a.cpp": "TEST(A, B) {}\n"}, "names that end in _test.cpp")
        self.expect({**readme, "tests/core/a_test.cpp": "int a;\n"}, "names that end in _test.cpp")

    def test_heavy_headers(self):
        heavy = {"core/io/a.h": "#pragma once\n#include <vtkImageData.h>\n", "core/io/a.cpp": '#include "core/io/a.h"\n'}
        self.expect(heavy, None)
        self.expect({**heavy, "core/io/b.h": '#pragma once\n#include "core/io/a.h"\n'}, "of their own folder")
        parallel = {"core/base/a.h": "#pragma once\n#include <tbb/task_group.h>\n"}
        self.expect({**parallel, "interfaces/a.cpp": '#include "core/base/a.h"\n'}, "of their own folder")
        self.expect({"interfaces/a.cpp": "#include <vtkImageData.h>\n"}, "which is for core/io")
        self.expect({"core/io/a.cpp": "#include <cairo/cairo.h>\n"}, "which is for core/picture")

    def test_slow_headers(self):
        readme = {"cli/README.md": "# cli\n"}
        self.expect({**readme, "cli/help.cpp": "#include <CLI/App.hpp>\n"}, None)
        self.expect({**readme, "cli/info.cpp": "#include <CLI/App.hpp>\n"}, "which is for cli/command.cpp")

    def test_files(self):
        self.expect({"core/base/a.h": "int a;\n"}, "#pragma once")
        self.expect({"core/base/a.cpp": "int a; \n"}, "ends in whitespace")
        self.expect({"core/base/a.cpp": "\tint a;\n"}, "has a tab")
        self.expect({"core/base/a.cpp": "int a;"}, "end with a newline")
        self.expect({"core/base/a.cpp": "int a;\n" + "<" * 7 + " HEAD\n"}, "line 2 is of a merge")
        self.expect({"core/base/a.cpp": '// see "/ho' + 'me/someone/x"\n'}, "absolute path")
        self.expect({"core/base/a.cpp": "// as SPEC 2.1 says\n"}, "line 1 cites SPEC")
        self.expect({"core/base/a.cpp": "// SPECIAL, DESIGNS\n", "core/base/CMakeLists.txt": "install(TARGETS a)\n"}, None)
        self.expect({"interfaces/README.md": None}, "interfaces: has no README.md")


class LicencesTest(unittest.TestCase):
    def test_licences_of_headers(self):
        strict = [
            "// SPDX-License-Identifier: GPL-3.0-or-later OR LicenseRef-Commercial\n",
            "/* SPDX-License-Identifier: AGPL-3.0-or-later */\n",
            " * under the terms of the GNU General Public\n * License as published\n",
            "# GNU Affero General Public License\n",
        ]
        free = [
            "",
            "// SPDX-License-Identifier: LGPL-3.0-or-later OR LicenseRef-Commercial\n",
            "// SPDX-License-Identifier: GPL-2.0 OR BSD-3-Clause\n",
            "/* SPDX-License-Identifier: GPL-2.0 WITH Linux-syscall-note */\n",
            "// the GNU General Public License ... the GCC Runtime Library Exception\n",
            "// the GNU Lesser General Public License\n",
        ]
        for text in strict:
            self.assertIsNotNone(check_licences.strict_licence(text), text)
        for text in free:
            self.assertIsNone(check_licences.strict_licence(text), text)

    def test_breaches(self):
        with tempfile.TemporaryDirectory() as folder:
            header = os.path.join(folder, "a.h")
            with open(header, "w", encoding="utf-8") as file:
                file.write("// SPDX-License-Identifier: GPL-3.0-or-later\n")
            found = {"a/CMakeFiles/one.dir/a.cpp.o": ["own.h", header], "a/CMakeFiles/two.dir/a.cpp.o": [header]}
            self.assertEqual(list(check_licences.breaches({"CMakeFiles/three.dir/b.o": ["own.h"]}, ["three"])), [])
            self.assertIn("nothing", list(check_licences.breaches(found, ["three"]))[0])
            (breach,) = check_licences.breaches(found, ["one"])
            self.assertIn(header, breach)
            self.assertIn("one.dir", breach)


if __name__ == "__main__":
    unittest.main()
