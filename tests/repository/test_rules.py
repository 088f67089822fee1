"""Rules of the repository that a reader would otherwise have to check by eye."""

import pathlib
import re

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
LIBRARIES = ("core", "flow", "dem")
TEXT = {
    ".cpp",
    ".hpp",
    ".py",
    ".pyi",
    ".cmake",
    ".txt",
    ".toml",
    ".md",
    ".qmd",
    ".yml",
    ".cff",
    ".bib",
    ".csv",
    "",
}
LONGEST_FILE = 400

# Diaries belong to git and to the changelog.
DIARY = re.compile(
    r"\b(?:TODO|FIXME|XXX|HACK|WIP|legacy|retired|no longer|formerly|previously|for now|used to be"
    r"|was (?:changed|renamed|moved|removed)|as of (?:now|today)|20\d\d-[01]\d-[0-3]\d)\b",
    re.IGNORECASE,
)
CITATION = re.compile(r"(?:\[|;\s*|, )([A-Z][A-Za-z]+(?:18|19|20)\d\d[a-z]?)(?=[\],;])")
PAGE_CITATION = re.compile(r"@([A-Z][A-Za-z]+(?:18|19|20)\d\d[a-z]?)\b")
MACHINE_PATH = re.compile(r"(?<![\w.$}~])/(?:work|tmp|home|root|opt|scratch|mnt)/")


def files(*folders: str, suffixes: set[str]) -> list[pathlib.Path]:
    """Files below the folders, without what builds and runs leave behind."""
    found = []
    for folder in folders:
        for path in sorted((ROOT / folder).rglob("*")):
            inside = path.relative_to(ROOT)
            hidden = any(
                part.startswith((".", "build", "__pycache__", "_site", "output")) for part in inside.parts
            )
            if path.is_file() and path.suffix in suffixes and not hidden:
                found.append(path)
    return found


CPP = files(*LIBRARIES, "python", "tests", suffixes={".cpp", ".hpp"})
CODE = CPP + files(*LIBRARIES, "python", "tests", "examples", "cmake", suffixes={".py", ".cmake"})
EVERYTHING = [
    path
    for path in files(*LIBRARIES, "python", "tests", "examples", "cmake", suffixes=TEXT)
    + [path for path in sorted(ROOT.iterdir()) if path.is_file() and path.suffix in TEXT]
    if path != pathlib.Path(__file__).resolve()
]


def lines_matching(pattern: re.Pattern, paths: list[pathlib.Path]) -> list[str]:
    return [
        f"{path.relative_to(ROOT)}:{number}: {line.strip()}"
        for path in paths
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
        if pattern.search(line)
    ]


def comments(path: pathlib.Path) -> list[tuple[int, str]]:
    """Comment text by line; for prose, everything."""
    text = path.read_text(encoding="utf-8").splitlines()
    if path.suffix in {".cpp", ".hpp"}:
        return [(n, line.partition("//")[2]) for n, line in enumerate(text, 1) if "//" in line]
    if path.suffix in {".cmake", ".toml", ".yml", ".txt"}:
        return [(n, line.partition("#")[2]) for n, line in enumerate(text, 1) if "#" in line]
    return list(enumerate(text, 1))


def test_files_have_one_subject_and_at_most_400_lines():
    sizes = {path.relative_to(ROOT): len(path.read_text(encoding="utf-8").splitlines()) for path in CODE}
    too_long = [f"{path}: {size} lines" for path, size in sizes.items() if size > LONGEST_FILE]
    assert not too_long, f"split these files (at most {LONGEST_FILE} lines):\n" + "\n".join(too_long)


@pytest.mark.parametrize(
    ("library", "allowed"), [("core", {"core"}), ("flow", {"core", "flow"}), ("dem", {"core", "dem"})]
)
def test_includes_point_one_way(library, allowed):
    include = re.compile(r'^\s*#\s*include\s*"([^"]+)"')
    wrong = []
    for path in files(library, suffixes={".cpp", ".hpp"}):
        for line in path.read_text(encoding="utf-8").splitlines():
            target = include.match(line)
            if target and (target[1].split("/")[0] not in allowed or not target[1].endswith(".hpp")):
                wrong.append(f"{path.relative_to(ROOT)} includes {target[1]}")
    wrong += lines_matching(
        re.compile(r"#\s*include\s*<(?:nanobind|Python|pybind11)"), files(library, suffixes={".cpp", ".hpp"})
    )
    assert not wrong, f"{library} may include {sorted(allowed)} only:\n" + "\n".join(wrong)


def test_headers_are_included_once():
    missing = [
        str(path.relative_to(ROOT))
        for path in CPP
        if path.suffix == ".hpp" and "#pragma once" not in path.read_text()
    ]
    assert not missing, "#pragma once is missing in:\n" + "\n".join(missing)


def test_loops_are_launched_by_the_helpers_of_core_loop():
    policy = re.compile(r"\b(?:parallel_(?:for|reduce|scan)|(?:MD)?RangePolicy|TeamPolicy|TeamThreadRange)\b")
    launches = lines_matching(policy, [path for path in CPP if path != ROOT / "core" / "loop.hpp"])
    assert not launches, "only core/loop.hpp names execution policies:\n" + "\n".join(launches)


def test_kernels_have_explicit_parameter_types():
    generic = lines_matching(re.compile(r"KOKKOS_(?:CLASS_)?LAMBDA\s*\([^)]*\bauto\b"), CPP)
    assert not generic, "nvcc rejects generic lambdas:\n" + "\n".join(generic)


def test_backends_are_named_in_one_place():
    space = re.compile(r"\bKokkos::(?:OpenMP|Cuda|CudaSpace|Serial|HIP|DefaultExecutionSpace)\b")
    named = lines_matching(space, [path for path in CPP if path != ROOT / "core" / "types.hpp"])
    assert not named, "use the aliases of core/types.hpp:\n" + "\n".join(named)


def test_environment_variables_do_not_change_results():
    reads = lines_matching(re.compile(r"\bgetenv\b"), CPP)
    assert not reads, "compiled code must not read the environment:\n" + "\n".join(reads)


def test_comments_are_no_diary():
    entries = [
        f"{path.relative_to(ROOT)}:{number}: {text.strip()}"
        for path in CODE + files("examples", suffixes={".qmd", ".md"})
        if path != pathlib.Path(__file__).resolve()
        for number, text in comments(path)
        if DIARY.search(text)
    ]
    assert not entries, "history belongs to git and CHANGELOG.md:\n" + "\n".join(entries)


def test_citations_exist_in_the_bibliography():
    bibliography = ROOT / "examples" / "references.bib"
    known = set(re.findall(r"@\w+\{\s*([^,\s]+)\s*,", bibliography.read_text(encoding="utf-8")))
    unknown = set()
    for path in CODE + files(*LIBRARIES, "examples", suffixes={".md", ".qmd"}):
        pattern = PAGE_CITATION if path.suffix == ".qmd" else CITATION
        unknown |= {
            f"{path.relative_to(ROOT)}: {key}"
            for _, text in comments(path)
            for key in pattern.findall(text)
            if key not in known
        }
    assert not unknown, f"not in {bibliography.relative_to(ROOT)}:\n" + "\n".join(sorted(unknown))


def test_no_paths_of_one_machine():
    found = lines_matching(MACHINE_PATH, EVERYTHING)
    assert not found, "paths that exist on one machine only:\n" + "\n".join(found)


def test_peclet_stays_a_namespace():
    assert not (ROOT / "python" / "peclet" / "__init__.py").exists()
