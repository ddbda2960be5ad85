#!/usr/bin/env python3
"""Shows that every check of the tree passes a good sample and fails on a bad one, and says why."""

import json
import pathlib
import tempfile
import unittest

import checks
from tree import Tree, without_comments

LAYERS = 'set(ASTROID_LAYER_core "")\nset(ASTROID_LAYER_sim core)\nset(ASTROID_LAYER_photometry core)\nset(ASTROID_LAYER_pipeline core sim photometry)\n'
GUIDE = "What lives here and where to begin. " * 5


def workflow(name, preset, steps):
    return {"name": name, "steps": [{"type": kind, "name": step.replace("*", preset)} for kind, step in steps]}


class ChecksOfTheTree(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.write("cmake/AstroidModule.cmake", LAYERS)
        self.write("docs/formulae.md", "- **F19** estimators.\n")
        self.write("docs/hard-cases.md", "| N14 | variance | Welford |\n")

    def write(self, name, text):
        path = pathlib.Path(self.folder.name, name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text if isinstance(text, bytes) else text.encode())

    def offences(self, check):
        return list(check(Tree(self.folder.name)))

    def expect(self, check, *parts):
        """The check finds exactly one offence per part, in order, each holding its part."""
        found = self.offences(check)
        self.assertEqual(len(found), len(parts), found)
        for sentence, part in zip(found, parts):
            self.assertIn(part, sentence)

    def test_layering_lets_a_module_include_what_is_below(self):
        self.write("sim/src/a.cpp", '#include "astroid/core/image.hpp"\n#include "astroid/sim/scene.hpp"\n#include <vector>\n')
        self.write("apps/pipeline/src/b.cpp", '#include "astroid/sim/scene.hpp"\n')
        self.expect(checks.layering)

    def test_layering_refuses_a_sibling_and_a_climb(self):
        self.write("sim/src/a.cpp", '\n#include "astroid/photometry/aperture.hpp"\n')
        self.write("sim/src/b.cpp", '#include "../../core/src/hidden.hpp"\n')
        self.write("core/include/astroid/core/c.hpp", "#  include <astroid/sim/scene.hpp>\n")
        self.expect(checks.layering, "core may not include", "sim/src/a.cpp:2: sim may not include", "climb")

    def test_sizes_refuses_one_huge_file_and_too_many_large_ones(self):
        for number in range(18):
            self.write(f"core/src/{number}.cpp", "//\n")
        self.write("core/src/large.cpp", "/" * 30000)
        self.expect(checks.sizes)
        self.write("core/src/huge.cpp", "/" * 70000)
        self.write("core/src/third.cpp", "/" * 30000)
        self.expect(checks.sizes, "huge.cpp: 70000", "3 of 24")

    def test_binaries_lets_a_small_image_pass(self):
        self.write("tests/golden/data/a.fits", b"SIMPLE\0\0")
        self.write("tests/unit/core/bad/garbage.xml", b"<\0\0")
        self.expect(checks.binaries)

    def test_binaries_refuses_what_is_prebuilt_binary_or_large(self):
        self.write("a/tool", b"\x7fELF\0\0")
        self.write("tests/unit/core/bad/huge.xml", b"\0" * 5000)
        self.write("b/lib.so", b"text")
        self.write("c/image.fits", b"\0" * 600 * 1024)
        self.write("d/stars.csv", b"1" * 5000 * 1024)
        self.expect(checks.binaries, "a/tool", "b/lib.so", "c/image.fits", "d/stars.csv", "bad/huge.xml")

    def test_references_match_in_both_directions(self):
        self.write("docs/references.bib", "@article{Short2013,\n}\n@book{Howell2006,\n}\n")
        self.write("core/src/a.hpp", "/// Text.\n/// @source Short2013 Eq. 5;\n///   Howell2006.\n/// @rng none\n")
        self.write("core/src/b.hpp", "/// @source F19, N14\n")
        self.expect(checks.references)

    def test_references_refuse_unknown_unused_and_shapeless(self):
        self.write("docs/references.bib", "@article{Short2013,\n}\n@article{Lone1999,\n}\n@article{Short2013,\n}\n")
        self.write("core/src/a.hpp", "/// @source Short2013 and\n///   Nobody2020.\n\n/// @source a book of Short2013\n")
        self.write("core/src/b.hpp", "/// @source F20 of Short2013\n")
        self.write("sim/src/effects/c.hpp", 'spec{"flat", "Nowhere1984"}\n')
        self.expect(checks.references, "Short2013 is there twice", "a.hpp:1: Nobody2020", "a.hpp:4: @source must begin", "b.hpp:1: F20", "c.hpp:1: the source Nowhere1984", "nothing refers to Lone1999")

    def test_guides_ask_every_folder_to_explain_itself(self):
        for folder in (*checks.FOLDERS_WITH_A_GUIDE, "tests/unit"):
            self.write(f"{folder}/README.md".lstrip("/"), GUIDE)
        self.write("tests/unit/core/a_test.cpp", "")
        self.expect(checks.guides)
        self.write("tests/physics/core/a_test.cpp", "")
        self.write("sim/README.md", "Simulation.")
        self.write("docs/README.md", GUIDE + "[there](absent.md) [here](../sim/README.md#top) [out](https://example.org)")
        self.expect(checks.guides, "sim/README.md: says", "tests/physics: has no", "docs/README.md:1: the link to absent.md")

    def test_forbidden_ignores_comments_strings_and_applications(self):
        self.write("core/src/a.cpp", '// std::mt19937, printf(\n/* exit(1) */ const char* s = "std::cout exit(";\nstd::snprintf(b, 3, s);\nexit_code(3);\n')
        self.write("apps/main.cpp", "std::cout << 1; exit(2);\n")
        self.write("CMakeLists.txt", "# never -ffast-math\nadd_compile_options(-ffp-contract=off)\n")
        self.expect(checks.forbidden)

    def test_forbidden_finds_each_construct(self):
        bad = ["std::mt19937 g;", "std::normal_distribution<double> d;", "std::fma(a, b, c);", "printf(\"x\");", "std::cerr << x;",
               "fmt::print(\"x\");", "std::exit(1);", "abort();", "std::random_device r;", "hn::MulAdd(a, b, c);"]
        for number, line in enumerate(bad):
            self.write(f"core/src/{number}.cpp", f"int a;\n{line}\n")
        found = self.offences(checks.forbidden)
        self.assertEqual(sorted({sentence.split(":")[0] for sentence in found}), sorted(f"core/src/{n}.cpp" for n in range(len(bad))))
        self.assertTrue(all(sentence.split(":")[1] == "2" for sentence in found), found)

    def test_forbidden_finds_flags(self):
        self.write("CMakeLists.txt", "add_compile_options(-ffast-math)\n")
        self.write("CMakePresets.json", '{"CMAKE_CXX_FLAGS": "-march=native"}')
        self.write("sim/CMakeLists.txt", "set(x -ffp-contract=fast)\n")
        self.expect(checks.forbidden, "-ffast-math", "-march=native", "-ffp-contract=")

    def test_workflows_must_agree_and_end_with_the_tests(self):
        steps = [("configure", "*"), ("build", "*-tidy"), ("build", "*"), ("test", "*")]
        self.write("CMakePresets.json", json.dumps({"workflowPresets": [workflow("check", "dev", steps), workflow("ci", "ci", steps)]}))
        self.expect(checks.workflows)
        self.write("CMakePresets.json", json.dumps({"workflowPresets": [workflow("check", "dev", steps), workflow("ci", "ci", steps[:-1])]}))
        self.expect(checks.workflows, "check runs", "must end with the tests")

    def test_evidence_must_exist(self):
        self.write("tests/unit/core/a_test.cpp", "TEST(Sum, IsExact) {}\nTEST_P(Sum,\n       OfNothing) {}\n")
        self.write("tests/bench/a_bench.cpp", "void BM_Sum(benchmark::State& state);\n")
        self.write("core/include/astroid/core/a.hpp", "/// @accuracy exact (tests: Sum.IsExact,\n/// Sum.OfNothing)  @complexity (bench: BM_Sum)\n")
        self.expect(checks.evidence)
        self.write("core/include/astroid/core/b.hpp", "/// @accuracy (test: Sum.IsRound) (bench: BM_Product)\n")
        self.expect(checks.evidence, "no test Sum.IsRound", "no benchmark BM_Product")

    def test_comments_are_blanked_and_lines_kept(self):
        self.assertEqual(without_comments('a; // b\n"c\\"d" /* e\nf */ g'), "a;     \n" + " " * 11 + "\n" + " " * 5 + "g")

    def test_every_check_has_a_test_here(self):
        covered = pathlib.Path(__file__).read_text()
        self.assertEqual([], [name for name in checks.ALL if f"checks.{name}" + "," not in covered])


if __name__ == "__main__":
    unittest.main()
