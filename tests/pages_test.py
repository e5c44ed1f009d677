"""The pages (*.md): README.md is short, links lead somewhere, tables have their form, and nothing stands twice."""

import importlib
import re
import subprocess
import sys
from collections import Counter
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import ModuleType
from unittest.mock import MagicMock

ROOT = Path(__file__).resolve().parent.parent
MOST_LINES = 200  # of README.md
LONG = 60  # words of a paragraph that may stand on one page only
PRECISION = ["function", "inputs", "ulps, at most", "mean", "roundings, at most", "mean"]
EXTREMES = ["", "case", "expected", "measured", "time"]
HOSTILE = ROOT / "tests/hostile", ROOT / "tools"  # where the hostile cases may be, the first that has any


# Pages.


def files() -> set[str]:
    """All files that belong to the project, relative to its root."""
    try:
        listed = subprocess.run(
            ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
            cwd=ROOT,
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        found = {name for name in listed.split("\0") if name}
    except (OSError, subprocess.CalledProcessError):  # not a checkout
        found = {
            str(path.relative_to(ROOT))
            for path in ROOT.rglob("*")
            if path.relative_to(ROOT).parts[0] not in ("build", ".git")
        }
    return {name for name in found if (ROOT / name).is_file()}


def prose(text: str) -> str:
    """A page without its code; lines keep their numbers."""

    def blank(match: re.Match) -> str:
        return re.sub(r"[^\n]", "", match[0])

    text = re.sub(r"^```.*?^```", blank, text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"(?<=\n\n)(?:    .*\n|\n)+", blank, text)
    return re.sub(r"`[^`\n]*`", lambda match: "`" * len(match[0]), text)


def anchors(text: str) -> set[str]:
    """The anchors that GitHub gives the headings of a page."""
    found, seen = set(), Counter()
    code = re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)
    for heading in re.findall(r"^#+ +(.*?)[ #]*$", code, flags=re.MULTILINE):
        words = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading).lower()
        name = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
        found.add(f"{name}-{seen[name]}" if seen[name] else name)
        seen[name] += 1
    return found


def broken_links(pages: dict[str, str], known: set[str]) -> list[str]:
    """Links and pictures of pages that lead nowhere."""
    folders = {str(parent) for name in known for parent in Path(name).parents}
    problems = []
    for page, text in pages.items():
        plain = prose(text)
        links = re.finditer(
            r"\]\(\s*<?([^()\s>]+)>?[^()]*\)|^\[[^\]]+\]:\s*(\S+)|(?:src|href)=\"([^\"]+)\"", plain, flags=re.MULTILINE
        )
        for link in links:
            target = link[1] or link[2] or link[3]
            if re.match(r"[a-z][a-z0-9+.-]*:", target):
                continue
            place = f"{page}:{plain.count(chr(10), 0, link.start()) + 1}"
            path, _, anchor = target.partition("#")
            absolute = (ROOT / page).parent / path if path else ROOT / page
            name = str(absolute.resolve().relative_to(ROOT)) if absolute.resolve().is_relative_to(ROOT) else target
            if name not in known and name not in folders:
                problems.append(f"{place}: {target} does not exist")
            elif anchor and anchor not in anchors(pages.get(name, "")):
                problems.append(f"{place}: {name} has no heading for #{anchor}")
    return problems


def paragraphs(text: str) -> set[str]:
    """Long paragraphs, list items too, with single spaces."""
    blocks = re.split(r"\n\s*\n|\n(?=[-*] |\d+\. |\|)", text)
    return {words for words in (" ".join(block.split()) for block in blocks) if len(words.split()) >= LONG}


def twice(pages: dict[str, str]) -> list[str]:
    """Long paragraphs that stand on several pages."""
    where: dict[str, list[str]] = {}
    for page, text in pages.items():
        for words in paragraphs(text):
            where.setdefault(words, []).append(page)
    return [
        f'{" and ".join(names)}: both have the paragraph "{" ".join(words.split()[:8])} ..."'
        for words, names in where.items()
        if len(names) > 1
    ]


# Generated tables.


def table(pages: dict[str, str], name: str, header: list[str], problems: list[str]) -> list[list[str]]:
    """The rows of the one table between the markers of a name."""
    found = [
        (page, match)
        for page, text in pages.items()
        for match in re.findall(rf"<!-- {name}: begin -->\n(.*?)<!-- {name}: end -->", text, flags=re.DOTALL)
    ]
    if len(found) != 1:
        problems.append(
            f"{len(found)} tables stand between <!-- {name}: begin --> and <!-- {name}: end -->; one should"
        )
        return []
    page, text = found[0]
    lines = text.splitlines()
    rows = [[cell.strip() for cell in line.removeprefix("|").removesuffix("|").split(" | ")] for line in lines]
    outside = [line for line in lines if not line.startswith(("| ", "|-")) or not line.endswith("|")]
    problems += [f'{page}, table {name}: a line that is no row: "{line}"' for line in outside]
    if rows[:1] != [header]:
        problems.append(f"{page}, table {name}: the header is {rows[:1]}; its tool writes {header}")
    if len(lines) < 3 or not re.fullmatch(r"\|( ?-+ ?\|)+", lines[1]) or lines[1].count("|") != len(header) + 1:
        problems.append(
            f"{page}, table {name}: the second line does not have {len(header)} columns of dashes, or no rows follow"
        )
    body = rows[2:]
    problems += [
        f'{page}, table {name}: the row "{" | ".join(row)}" has {len(row)} cells, not {len(header)}'
        for row in body
        if len(row) != len(header)
    ]
    return [row for row in body if len(row) == len(header)]


def check_precision(pages: dict[str, str], problems: list[str]) -> None:
    """A table of the numbers that tests/precision_test.cpp prints."""
    problems += [
        f'table precision: the row of "{row[0]}, {row[1]}" has cells that are no numbers'
        for row in table(pages, "precision", PRECISION, problems)
        if not all(re.fullmatch(r"\d+(\.\d+)?(e[+-]\d+)?", cell) for cell in row[2:])
    ]


class Pretended:
    """Finds packages that are not installed: cases only name them before they run."""

    @staticmethod
    def find_spec(name: str, path: object = None, target: object = None) -> ModuleSpec | None:
        if name.partition(".")[0] in sys.stdlib_module_names:
            return None
        return ModuleSpec(name, Pretended, is_package=True)

    @staticmethod
    def create_module(spec: ModuleSpec) -> ModuleType:
        module = MagicMock(name=spec.name)
        module.__path__ = []
        return module

    @staticmethod
    def exec_module(module: ModuleType) -> None:
        pass


def case_sources() -> list[Path]:
    """The Python files that register hostile cases."""
    for folder in HOSTILE:
        found = [
            path
            for path in sorted(folder.glob("*.py"))
            if re.search(r"^ *@?case\(", path.read_text(), flags=re.MULTILINE)
        ]
        if found:
            return found
    return []


def known_cases(sources: list[Path]) -> list[tuple[str, str, str]]:
    """Group, name and expectation of each case, by importing what registers them."""
    sys.dont_write_bytecode = True
    sys.path[:0] = [
        str(sources[0].parent),
        *(str(path) for path in (ROOT / "tools").iterdir() if path.is_dir()),
        str(ROOT / "tools"),
    ]
    sys.meta_path.append(Pretended)
    for source in sources:
        importlib.import_module(source.stem)
    cases = [
        case
        for module in list(sys.modules.values())
        if isinstance(found := vars(module).get("CASES"), list)
        for case in found
    ]
    return list(dict.fromkeys((case.group, case.name, case.expected) for case in cases))


def check_extremes(pages: dict[str, str], problems: list[str]) -> None:
    """A row for each hostile case, in the form that tools/extremes writes."""
    rows = table(pages, "extremes", EXTREMES, problems)
    if not rows:
        return
    sources = case_sources()
    if not sources:
        problems.append("table extremes: no file of tests/hostile or tools registers cases by case(...)")
        return
    try:
        cases = known_cases(sources)
    except Exception as error:
        least = sum(len(re.findall(r"^ *@?case\(", source.read_text(), flags=re.MULTILINE)) for source in sources)
        print(f"cases are only counted, since {sources[0].parent} cannot be imported: {error!r}")
        if len(rows) < least:
            problems.append(f"table extremes: {len(rows)} rows for {least} cases or more")
        return
    written = Counter(tuple(row[:3]) for row in rows)
    problems += [
        f'table extremes: no row "{" | ".join(case)}"; run tools/extremes --heavy -o FOLDER and take its table.md'
        for case in cases
        if case not in written
    ]
    problems += [f'table extremes: a row of no case, "{" | ".join(row)}"' for row in written if row not in cases]
    problems += [f'table extremes: "{row[1]}" has {count} rows' for row, count in written.items() if count > 1]


def main() -> int:
    """Says all that is wrong."""
    known = files()
    pages = {name: (ROOT / name).read_text() for name in sorted(known) if name.endswith(".md")}
    problems: list[str] = []
    length = len(pages["README.md"].splitlines())
    if length > MOST_LINES:
        problems.append(
            f"README.md: {length} lines; allowed: {MOST_LINES}. Move some to the README of the folder they are about"
        )
    problems += broken_links(pages, known) + twice(pages)
    check_precision(pages, problems)
    check_extremes(pages, problems)
    print("\n".join(problems) or f"{len(pages)} pages are in order")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
