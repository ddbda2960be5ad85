"""The rules of the tree that a machine can check. Each check yields one sentence per offence, none when all is well."""

import pathlib
import re

from tree import CODE, is_library, module_of, without_comments

KIB = 1024


def layering(tree):
    """Modules include only modules below them, as cmake/AstroidModule.cmake states, and never reach into another's src."""
    declared = re.findall(r"^set\(ASTROID_LAYER_(\w+) ([^)]*)\)", tree.text("cmake/AstroidModule.cmake"), re.MULTILINE)
    allowed = {name: {name, *below.replace('"', "").split()} for name, below in declared}
    for name in tree.code():
        module = module_of(name)
        if module is None:
            continue
        for number, line in tree.lines(name):
            include = re.match(r'\s*#\s*include\s*["<]([^">]+)[">]', line)
            if include is None:
                continue
            if ".." in pathlib.PurePosixPath(include[1]).parts:
                yield f"{name}:{number}: an include must not climb out of its folder: {include[1]}"
            public = re.match(r"astroid/(\w+)/", include[1])
            if public and public[1] not in allowed[module]:
                yield f"{name}:{number}: {module} may not include {include[1]} (allowed: {' '.join(sorted(allowed[module]))})"


LARGEST_SOURCE = 60 * KIB
LARGE_SOURCE = 20 * KIB
SHARE_OF_SMALL_SOURCES = 0.9


def sizes(tree):
    """No source above 60 KB, 90 % of them below 20 KB."""
    bytes_of = {name: (tree.root / name).stat().st_size for name in tree.files() if name.endswith((*CODE, ".py", ".cmake", ".md"))}
    for name, size in bytes_of.items():
        if size > LARGEST_SOURCE:
            yield f"{name}: {size} bytes, the limit is {LARGEST_SOURCE}"
    large = sorted(name for name, size in bytes_of.items() if size > LARGE_SOURCE)
    if len(large) > (1 - SHARE_OF_SMALL_SOURCES) * len(bytes_of):
        yield f"{len(large)} of {len(bytes_of)} sources are above {LARGE_SOURCE} bytes: {' '.join(large)}"


LARGEST_BINARY = 512 * KIB
LARGEST_DATA = 4096 * KIB
BINARY_FORMATS = (".fits", ".png")
LARGEST_BROKEN_INPUT = 4 * KIB
FOLDERS_OF_BROKEN_INPUTS = re.compile(r"^tests/.*/(bad|broken)/")
PREBUILT = (".a", ".so", ".o", ".dll", ".exe", ".jar", ".whl", ".deb", ".zip", ".gz", ".xz", ".tar", ".pyc")


def binaries(tree):
    """Nothing prebuilt, packed or large is tracked: a binary is FITS, a PNG figure or a tiny broken input of a test."""
    for name in tree.files():
        path = tree.root / name
        size = path.stat().st_size
        with path.open("rb") as stream:
            binary = b"\0" in stream.read(8 * KIB)
        if name.endswith(PREBUILT):
            yield f"{name}: prebuilt or packed files have no place in the tree"
        elif FOLDERS_OF_BROKEN_INPUTS.match(name) and size <= LARGEST_BROKEN_INPUT:
            continue
        elif binary and not name.endswith(BINARY_FORMATS):
            yield f"{name}: a binary that is neither FITS nor PNG"
        elif binary and size > LARGEST_BINARY:
            yield f"{name}: {size} bytes, the limit for binaries is {LARGEST_BINARY}"
        elif size > LARGEST_DATA:
            yield f"{name}: {size} bytes, the limit is {LARGEST_DATA}"


KEY = re.compile(r"\b[A-Z][A-Za-z]+\d{4}[a-z]?\b")
NUMBER = re.compile(r"\b[FN]\d{1,3}\b")


def source_tags(tree):
    """Yields (file, line, text) of every `@source` tag: the rest of its comment up to the next tag, empty line or its end."""
    for name in tree.code():
        text = None
        for number, line in tree.lines(name):
            comment = re.search(r"//[/!]?<?(.*)", line)
            words = comment[1] if comment else ""
            if text is not None and (not words.strip() or "@" in words):
                yield name, begin, text + words.split("@")[0]
                text = None
            elif text is not None:
                text += " " + words
            if "@source" in words:
                begin, text = number, words.split("@source", 1)[1].split("@")[0]
        if text is not None:
            yield name, begin, text


def references(tree):
    """Every @source begins with a key of docs/references.bib or a number of docs/formulae.md or hard-cases.md; no key is idle."""
    known = re.findall(r"^@\w+\s*\{\s*([^,\s]+)\s*,", tree.text("docs/references.bib"), re.MULTILINE)
    for key in sorted({key for key in known if known.count(key) > 1}):
        yield f"docs/references.bib: {key} is there twice"
    numbers = set(re.findall(r"^- \*\*(F\d+)\*\*|^\| (N\d+) \|", tree.text("docs/formulae.md") + tree.text("docs/hard-cases.md"), re.MULTILINE))
    numbers = {formula or case for formula, case in numbers}
    for name, number, text in source_tags(tree):
        keys = KEY.findall(text)
        if not (KEY.match(text.strip()) or NUMBER.match(text.strip())):
            yield f"{name}:{number}: @source must begin with a key of docs/references.bib or F.., N.., not with '{text.strip()[:40]}'"
        for formula in NUMBER.findall(text):
            if formula not in numbers:
                yield f"{name}:{number}: {formula} is neither in docs/formulae.md nor in docs/hard-cases.md"
        for key in keys:
            if key not in known:
                yield f"{name}:{number}: {key} is not in docs/references.bib"
    for name in tree.code():
        if name.startswith("sim/src/effects/"):
            for number, line in tree.lines(name):
                for key in re.findall(r'"([A-Z][A-Za-z]+\d{4}[a-z]?)"', line):
                    if key not in known:
                        yield f"{name}:{number}: the source {key} of an effect is not in docs/references.bib"
    readable = [name for name in tree.files() if name.endswith((*CODE, ".md", ".xml", ".csv", ".py")) and not name.startswith("docs/references")]
    used = set()
    for name in readable:
        used.update(KEY.findall(tree.text(name)))
    for key in known:
        if key not in used:
            yield f"docs/references.bib: nothing refers to {key}"


FOLDERS_WITH_A_GUIDE = ("", "core", "catalogues", "sim", "photometry", "analysis", "reports", "apps", "tests", "docs")
FEWEST_WORDS = 25


def guides(tree):
    """Every folder that a newcomer opens says what lives there; the labels of tests/ too; links in texts lead somewhere."""
    labels = sorted({name.split("/")[1] for name in tree.files() if name.startswith("tests/") and name.count("/") > 1})
    for folder in (*FOLDERS_WITH_A_GUIDE, *(f"tests/{label}" for label in labels)):
        guide = tree.root / folder / "README.md"
        if not guide.is_file():
            yield f"{folder or '.'}: has no README.md"
        elif len(guide.read_text().split()) < FEWEST_WORDS:
            yield f"{folder}/README.md: says next to nothing"
    for name in tree.files():
        if not name.endswith(".md"):
            continue
        for number, line in tree.lines(name):
            for target in re.findall(r"\]\(([^)#\s]+)[^)]*\)", line):
                if "://" not in target and not (tree.root / name).parent.joinpath(target).exists():
                    yield f"{name}:{number}: the link to {target} leads nowhere"


FORBIDDEN_IN_CODE = {
    r"\bmt19937|\bminstd_rand|\bdefault_random_engine|\brandom_device|\bstd::rand\b|\bs?rand\(": "random numbers come from astroid/core/random.hpp",
    r"\bstd::\w+_distribution\b": "distributions of <random> differ between libraries: use astroid/core/random.hpp",
    r"\bstd::fmaf?\b|\b__builtin_fmaf?\b|\bMulAdd\b": "no fused multiply-add: results must not depend on the processor",
    r"\bApproximateReciprocal\w*|\bSumOfLanes\b": "approximate or order-dependent vector operations are not reproducible",
}
FORBIDDEN_IN_LIBRARIES = {
    r"\b(std::)?(f|v|vf)?printf\s*\(|\b(std::)?f?puts\s*\(|\bfmt::print\b|\bstd::(cout|cerr|clog)\b": "libraries never print",
    r"\b(std::)?(_?exit|quick_exit|abort|terminate)\s*\(": "libraries never end the program",
}
FORBIDDEN_FLAGS = {
    r"-ffast-math|-funsafe-math-optimizations|-Ofast|-ffp-contract=(?!off)": "changes results",
    r"-march=native|-mtune=native|-mfma\b": "makes results depend on the machine that compiles",
}


def forbidden(tree):
    """No construct that breaks reproducibility; libraries neither print nor exit."""
    def offences(name, text, rules):
        for pattern, reason in rules.items():
            for match in re.finditer(pattern, text):
                number = text.count("\n", 0, match.start()) + 1
                yield f"{name}:{number}: {match.group().strip()}: {reason}"

    for name in tree.code():
        text = without_comments(tree.text(name))
        yield from offences(name, text, FORBIDDEN_IN_CODE)
        if is_library(name):
            yield from offences(name, text, FORBIDDEN_IN_LIBRARIES)
    for name in tree.build_files():
        text = re.sub(r"(?m)^\s*#.*$", "", tree.text(name))
        yield from offences(name, text, FORBIDDEN_FLAGS)


def workflows(tree):
    """`check` and `ci` run the same steps, on their own preset, and end with the tests."""
    import json
    presets = json.loads(tree.text("CMakePresets.json"))["workflowPresets"]
    steps = {p["name"]: [(s["type"], re.sub(r"^(dev|ci)\b", "*", s["name"])) for s in p["steps"]] for p in presets}
    if steps["check"] != steps["ci"]:
        yield f"CMakePresets.json: check runs {steps['check']}, ci runs {steps['ci']}"
    if steps["ci"][-1][0] != "test":
        yield "CMakePresets.json: the workflow ci must end with the tests"


def evidence(tree):
    """A test or benchmark that a comment of a library calls as witness exists."""
    tests, benchmarks = set(), set()
    for name in tree.code():
        if name.startswith("tests/"):
            text = tree.text(name)
            tests.update(f"{suite}.{test}" for suite, test in re.findall(r"\bTEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\)", text))
            benchmarks.update(re.findall(r"\bBM_\w+", text) if name.startswith("tests/bench/") else ())
    for name in tree.code():
        if not is_library(name):
            continue
        text = re.sub(r"\n\s*///?", "", tree.text(name))
        for named in re.findall(r"\btests?: ((?:\w+\.\w+(?:, | and )?)+)", text):
            for test in re.findall(r"\w+\.\w+", named):
                if test not in tests:
                    yield f"{name}: there is no test {test}"
        for benchmark in re.findall(r"\bBM_\w+", text):
            if benchmark not in benchmarks:
                yield f"{name}: there is no benchmark {benchmark}"


ALL = {check.__name__: check for check in (layering, sizes, binaries, references, guides, forbidden, workflows, evidence)}
