"""What the checks of the tree look at: the files that git tracks, or every file of a sample tree that has no .git."""

import pathlib
import re
import subprocess

LIBRARIES = ("core", "catalogues", "sim", "photometry", "analysis", "reports", "apps/pipeline")
CODE = (".hpp", ".cpp")
BUILD_FILES = ("CMakeLists.txt", "CMakePresets.json", "Makefile")


class Tree:
    def __init__(self, root):
        self.root = pathlib.Path(root)

    def files(self):
        """Paths relative to the root, sorted."""
        if (self.root / ".git").exists():
            listed = subprocess.run(
                ["git", "-c", f"safe.directory={self.root}", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                cwd=self.root, capture_output=True, check=True, text=True).stdout.split("\0")
            names = [name for name in listed if name and (self.root / name).is_file()]
        else:
            names = [str(path.relative_to(self.root)) for path in self.root.rglob("*") if path.is_file()]
        return sorted(names)

    def code(self):
        return [name for name in self.files() if name.endswith(CODE)]

    def build_files(self):
        return [name for name in self.files() if name.endswith((".cmake", *BUILD_FILES))]

    def text(self, name):
        return (self.root / name).read_text(encoding="utf-8", errors="replace")  # some inputs of tests are broken on purpose

    def lines(self, name):
        return enumerate(self.text(name).splitlines(), start=1)


def module_of(name):
    """The layer that a file belongs to, or None: 'core/src/a.cpp' -> 'core', 'apps/pipeline/src/b.cpp' -> 'pipeline'."""
    parts = pathlib.PurePosixPath(name).parts
    if parts[:2] == ("apps", "pipeline"):
        return "pipeline"
    return parts[0] if parts[0] in {"core", "catalogues", "sim", "photometry", "analysis", "reports", "apps"} else None


def is_library(name):
    return name.startswith(tuple(f"{folder}/" for folder in LIBRARIES))


def without_comments(text):
    """C++ text with comments and the inside of string literals blanked, line numbers kept."""
    pattern = re.compile(r'R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'|//[^\n]*|/\*.*?\*/', re.DOTALL)
    return pattern.sub(lambda match: re.sub(r"[^\n]", " ", match.group()), text)
