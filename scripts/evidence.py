#!/usr/bin/env python3
"""The pages of docs/evidence: what each of them claims, when its runs were made, and with which version of the solver.

    scripts/evidence.py            write docs/evidence/claims.md and the heads of the pages
    scripts/evidence.py --check    end with 1 if a claim, a head or a number that a page for users repeats is not what the pages say, and name the
                                   parts that are older than the solver
    scripts/evidence.py --turn [N] run the script of the part whose turn it is today (or the N-th), and end with 1 if a number of its claims has changed

A page consists of the parts that scripts write with `runs.write`. The date, the commit and the version of the solver of each part are in
docs/evidence/stamps.json. Claims take their numbers from the pages, so a new run of a script changes them.
Needs only Python's standard library; `--turn` builds the program.
"""

import csv
import datetime
import difflib
import io
import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FOLDER = ROOT / "docs" / "evidence"
STAMPS = FOLDER / "stamps.json"

# The parts of each page. A page of one part has its title; a page of several has a title of its own.
PAGES = {
    "verification": ("", ["verification"]),
    "paper": ("The paper: its claims, its figures, and an independent solver", ["physics", "reproduction", "agreement"]),
    "choices": ("", ["choices"]),
    "accuracy": ("", ["accuracy"]),
    "mesh_errors": ("", ["mesh_errors"]),
    "eigenvalues": ("Eigenvalues of steady sliding", ["eigenvalues", "verdicts"]),
    "stability": ("", ["stability"]),
    "elastic_disk": ("", ["elastic_disk"]),
    "scenes": ("Holder, friction law, base and diameter", ["scenes", "holders"]),
    "strains": ("Large strains and yielding", ["large_strains", "yielding_pin"]),
    "rig": ("", ["rig"]),
    "growing": ("", ["growing"]),
    "calibration_proof": ("", ["calibration_proof"]),
    "speed": ("Speed and forecasts", ["performance", "cost"]),
}
# A table with more rows is a file beside its page.
LONGEST_TABLE = 36
PAGE_OF = {part: page for page, (_, parts) in PAGES.items() for part in parts}

# The part, what it claims, and the words of the part that have the numbers. White space counts as one blank.
CLAIMS = [
    ("verification", "The solver agrees with exact answers in {1} cases of {0} tests; {2} numbers are compared.", r"(\d+) tests passed, 0 failed; (\d+) cases with (\d+) rows"),
    ("physics", "{0} of {0} jobs of Figure 7 at μ ≥ 0.3 reach a limit cycle, as in the paper.", r"(\d+) of \1 jobs at μ ≥ 0\.3 are periodic"),
    ("physics", "At 7 rpm and μ = 0.4 the frequency is {1} times the paper's 14.5 kHz.", r"limit-cycle frequency at 7 rpm \| 14 500 Hz \| (\d+) Hz \| ([\d.]+) times"),
    ("reproduction", "The damping that the paper leaves open moves μ\\* of its reference job from {0} to {1}.", r"\| 0\.5 \| 0 ns \| ([\d.]+) \|.*?\| 1 \| 27\.5 ns \| ([\d.]+) \|"),
    ("agreement", "A second solver, in Python, gives the same μ\\* within {0} at six speeds and one stable point.", r"largest difference of μ\* in this table is ([\d.]+\d)"),
    ("agreement", "The leading friction modes of the program, of an assembly with scipy and of CalculiX agree to a relative {0}.", r"Both differences are below (\S+), as"),
    ("choices", "What the paper leaves open moves μ\\* at μ = 0.4 and 7 rpm between {0} and {1}.", r"\| 7 \|[^|]*\|[^|]*\|[^|]*\| ([\d.]+) … ([\d.]+)"),
    ("accuracy", "With the settings of `figure7` the error of μ\\* by mesh and time step is at most {0} % at four speeds (μ = 0.4, β_R = 50 ns).", r"largest error of μ\\\* over the four speeds is ([\d.]+) %"),
    ("mesh_errors", "{1} % of {0} errors of μ\\* on the second mesh are within their bounds, in the scenes for which the bounds were chosen.", r"\| 2, after 1 \| (\d+) \| ([\d.]+) % \|"),
    ("mesh_errors", "In scenes that took no part in the choice of the bounds, {0} of {1} errors are within them.", r"took no part (\d+) of (\d+) are covered"),
    ("eigenvalues", "The sign of the growth rate agrees with {2} of {1} runs that decay or are periodic; limit cycles beside stable sliding were found up to {0} % below the threshold.", r"largest distance at which a cycle was found is (\d+) %.*?Of the (\d+) runs that decay or are periodic, (\d+) agree with the sign"),
    ("verdicts", "In {0} cases the modes of a random pin say something else than its run, and nothing explains it.", r"Not explained: (\d+)"),
    ("stability", "The energies of all {0} results of hostile scenes close.", r"The energies of all (\d+) results close"),
    ("elastic_disk", "At μ = 0.4 the steel disk lowers the frequency by {0} to {1} % and changes μ\\* by {2} to +{3}.", r"lowers the frequency by ([\d.]+) to ([\d.]+) %\*\* and changes μ\\?\* by (-[\d.]+) to \+([\d.]+\d)"),
    ("scenes", "A holder changes μ\\* by up to {0} %.", r"largest change of μ\\\* from the ideal clamp is (\d+) %"),
    ("holders", "{1} of {0} results with a holder differ from a run ten times as long by more than 1 %.", r"Of (\d+) results, (\d+) differ from the long run by more than 1 %"),
    ("large_strains", "A rubber pin squeals {0} % higher than the linear model says at {1} % of mean strain.", r"and ([\d.]+) % higher at ([\d.]+) %\."),
    ("yielding_pin", "An aluminium pin whose edges yield and shake down has a μ\\* within {0} % of a linear pin.", r"μ\\\* is within ([\d.]+) % and the frequency"),
    ("rig", "A rig from the literature has its growing mode here. On the mesh of full elements it is {0} % too high, against an assembly with quadratic elements, and grows {1} to {2} times too fast.", r"the last mesh above is ([\d.]+) % too high in frequency, and its growth rate is ([\d.]+) to ([\d.]+) times too large"),
    ("growing", "A grid that finds as much as `studies/refine.json` has {0} times as many jobs.", r"\*\*([\d.]+) times as many\*\*"),
    ("calibration_proof", "In {1} of {0} synthetic experiments the truth is inside the region.", r"given (\d+) synthetic experiments\. \*\*The truth was inside the region in (\d+) of them"),
    ("performance", "The settings of the presets solve `figure7` {0} times as fast as the defaults.", r"nested start, eigenvalues: the presets \| \d+ \| ([\d.]+) \|"),
    ("cost", "{0} of {1} studies took a time within their first forecast.", r"The times of (\d+) of (\d+) studies lie in their predicted ranges"),
]
# Pages for users that repeat numbers of a claim: the page, the claim by its part and its place there, the places of the numbers in it (of several
# places the largest size), and the words.
QUOTES = [
    ("solving", "mesh_errors", 1, [0, 1], r"In scenes that took no part, (\d+) of (\d+) errors"),
    ("calibrate", "calibration_proof", 0, [0], r"has (\d+) experiments whose truth is known"),
    ("study", "elastic_disk", 0, [(2, 3), 1], r"μ\\\* changes by at most ([\d.]+) and the frequency by at most ([\d.]+) %"),
]
# The numbers of these claims depend on times, which are never twice the same. Only a change by more than this factor counts.
FACTOR = {"performance": 1.25, "cost": 1.25}


def head_commit():
    done = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True)
    return done.stdout.strip()


def solver_version():
    return int(re.search(r'pub const VERSION: &str = "(\d+)"', (ROOT / "src/mechanics/solver/mod.rs").read_text())[1])


def stamps():
    return json.loads(STAMPS.read_text())


def stamp(part):
    """Notes that a part was written now, from results of this version of the solver: keys of kept results have the version."""
    known = stamps()
    changed = subprocess.run(["git", "status", "--porcelain", "src", "Cargo.lock"], cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout
    commit = head_commit() + (" with changes" if changed else "")
    known[part] = {"date": datetime.date.today().isoformat(), "commit": commit, "solver": solver_version()}
    STAMPS.write_text(json.dumps(known, indent=1, sort_keys=True) + "\n")


def stamp_again(part, number, count):
    """Notes that one of the `count` samples of a part whose runs take hours was computed again, and that its results were the kept ones."""
    known = stamps()
    own = known[part].get("again", {})
    samples = own["samples"] if own.get("solver") == solver_version() else []
    known[part]["again"] = {"date": datetime.date.today().isoformat(), "of": count, "samples": sorted({*samples, number}), "solver": solver_version()}
    STAMPS.write_text(json.dumps(known, indent=1, sort_keys=True) + "\n")


def again_in_words(own):
    """How many samples of a part gave the same with the version of now; empty if none was computed again."""
    found = own.get("again", {})
    if found.get("solver") != solver_version():
        return ""
    return f"version {found['solver']} gives the same for {len(found['samples'])} of {found['of']} samples"


def solver_of(own):
    """The version of the solver of a part, and what the version of now says of it."""
    return "; ".join(filter(None, [str(own["solver"]), again_in_words(own)]))


def collapsed(text):
    return " ".join(text.split())


def claims(part, text):
    """The claims of a part, each a sentence and its numbers. The words that have a number must be in the text."""
    for own, sentence, pattern in CLAIMS:
        if own == part:
            found = re.search(pattern, collapsed(text))
            if not found:
                sys.exit(f"the part `{part}` of docs/evidence/{PAGE_OF[part]}.md has no words like {pattern}, from which its claim takes its numbers")
            yield sentence.format(*found.groups()), found.groups()


def sentences(part, text):
    return [sentence for sentence, _ in claims(part, text)]


def wrong_quotes():
    """Each sentence of a page for users whose numbers are not those of the claim that it repeats."""
    for page, part, place, numbers, pattern in QUOTES:
        found = re.search(pattern, collapsed((ROOT / "docs" / f"{page}.md").read_text()))
        _, all_of_claim = list(claims(part, parts(PAGE_OF[part])[part]))[place]
        places = [own if isinstance(own, tuple) else (own,) for own in numbers]
        of_claim = [max(abs(float(all_of_claim[place])) for place in own) for own in places]
        if not found or [float(number) for number in found.groups()] != of_claim:
            yield f"docs/{page}.md has no words like {pattern} with the numbers of docs/evidence/{PAGE_OF[part]}.md: {of_claim}"


def has_changed(part, before, now):
    """Whether a number of a claim is another one."""
    factor = FACTOR.get(part)
    if factor is None:
        return before != now
    pairs = [sorted([float(old), float(new)]) for old, new in zip(before, now, strict=True)]
    return any(high > factor * low for low, high in pairs)


def origin(part, known):
    own = known[part]
    now = solver_version()
    version = f"version {own['solver']} of the solver" + (f", which is at {now} now" if own["solver"] != now else "")
    return ", ".join([own["date"], f"commit {own['commit']}", "; ".join(filter(None, [version, again_in_words(own)]))])


def head(part, text, known):
    claims = " ".join(f"**{sentence}**" for sentence in sentences(part, text))
    return f"{claims} *Results of {origin(part, known)}.*".strip()


def bare(text):
    """A text without the heads that this script has put into it."""
    return re.sub(r"<!-- head -->.*?<!-- /head -->\n\n?", "", text, flags=re.S)


def with_head(part, text, known):
    """A part with its head below its title."""
    title, rest = text.split("\n", 1)
    return f"{title}\n\n<!-- head -->\n{head(part, text, known)}\n<!-- /head -->\n\n{rest.lstrip()}"


def demoted(text):
    """A part as a chapter of a page: its headings are one level down."""
    blocks = text.split("```")
    blocks[::2] = [re.sub(r"^#", "##", block, flags=re.M) for block in blocks[::2]]
    return "```".join(blocks)


def promoted(text):
    blocks = text.split("```")
    blocks[::2] = [re.sub(r"^##", "#", block, flags=re.M) for block in blocks[::2]]
    return "```".join(blocks)


def parts(page):
    """The parts of a page as their scripts wrote them."""
    title, names = PAGES[page]
    path = FOLDER / f"{page}.md"
    text = bare(path.read_text())
    if not title:
        return {names[0]: text}
    _, *found = re.split(r"<!-- part (\w+) -->\n", text)
    return {name: promoted(own).rstrip() + "\n" for name, own in zip(found[::2], found[1::2])}


def page_text(page, own):
    """A page of its parts."""
    title, names = PAGES[page]
    known = stamps()
    if not title:
        return with_head(names[0], own[names[0]], known)
    chapters = [f"<!-- part {name} -->\n{demoted(with_head(name, own[name], known)).rstrip()}\n" for name in names]
    return f"# {title}\n\n" + "\n".join(chapters)


def with_tables_as_files(part, text):
    """A part whose long tables are files beside the page, and these files by their names."""
    files = {}

    def file_of(found):
        lines = found[0].rstrip("\n").split("\n")
        rows = [[re.sub(r"\\(.)|\*\*|`", r"\1", cell).strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines]
        if len(rows) - 2 <= LONGEST_TABLE:
            return found[0]
        name = f"{part}_table{len(files) + 1 if files else ''}.csv"
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows([rows[0], *rows[2:]])
        files[name] = text.getvalue()
        columns = "; ".join(cell.strip() for cell in re.split(r"(?<!\\)\|", lines[0])[1:-1])
        return f"The table is in [{name}]({name}): {len(rows) - 2} rows with the columns {columns}.\n"

    return re.sub(r"(?:^\|.*(?:\n|\Z))+", file_of, text, flags=re.M), files


def with_part(part, text):
    """The files of the page in which a part has a new text, by their names."""
    page = PAGE_OF[part]
    text, files = with_tables_as_files(part, text)
    return {f"{page}.md": page_text(page, {**parts(page), part: text}), **files}


CLAIMS_PAGE = """# Claims and numbers

`scripts/evidence.py` writes this page. Each claim takes its numbers from the page that it names. The last columns say which runs the numbers come from
([stamps.json](stamps.json)). The solver is at version {version} now; {old} of {count} parts come from an older one. Versions change for many reasons, most of which move no number of these pages
([history](../developers/history.md)). Every night one of the parts, or some results of a part that takes hours, is computed again, and the numbers must not have changed ([Nightly](../developers/nightly.md#evidence-in-turn)).
Origins of before 2026-11-28 are the commits in which a number in the tables of the part has changed for the last time.

| claim | page | date | commit | solver |
|---|---|---|---|---|
{rows}

What is not verified: [verification.md](verification.md#what-is-not-verified), [accuracy.md](accuracy.md#not-verified), [mesh_errors.md](mesh_errors.md#not-known),
[stability.md](stability.md#what-is-not-verified), [eigenvalues.md](eigenvalues.md#what-is-not-covered). What is not modelled: [theory.md](theory.md#what-is-not-modelled).
That the tests catch wrong programs: [mutants.md](../developers/mutants.md).
"""


def claims_page(every):
    known = stamps()
    rows = []
    for part, text in every.items():
        for sentence in sentences(part, text):
            own = known[part]
            rows.append(f"| {sentence} | [{PAGE_OF[part]}.md]({PAGE_OF[part]}.md) | {own['date']} | {own['commit']} | {solver_of(own)} |")
    old = sum(own["solver"] < solver_version() for own in known.values())
    return CLAIMS_PAGE.format(version=solver_version(), old=old, count=len(known), rows="\n".join(rows))


def written():
    """Each page of this script with what it should be."""
    own = {page: parts(page) for page in PAGES}
    every = {part: text for page in own.values() for part, text in page.items()}
    pages = {f"{page}.md": page_text(page, found) for page, found in own.items()}
    return {**pages, "claims.md": claims_page(every)}


# The parts of which one is computed again each night. Their scripts take from minutes to a few hours on two cores.
TURNS = ["agreement", "scenes", "growing", "verdicts", "elastic_disk", "reproduction", "physics", "large_strains", "yielding_pin", "holders", "rig", "mesh_errors",
         "stability", "eigenvalues", "accuracy", "calibration_proof", "verification", "choices", "cost", "performance"]
SCRIPT_OF = {"large_strains": "strains", "yielding_pin": "yielding", "calibration_proof": "calibration"}
# The scripts of these parts take hours. `again NUMBER` computes some of their results again, and ends with this code if one differs. After an error
# Python ends with 1.
KEPT, DIFFERS = ["mesh_errors", "accuracy", "calibration_proof"], 3


def turn(number):
    part = TURNS[number % len(TURNS)]
    page = PAGE_OF[part]
    before = parts(page)[part]
    script = f"scripts/{SCRIPT_OF.get(part, part)}.py"
    print(f"{script}: last run {origin(part, stamps())}", flush=True)
    if part in KEPT:
        ended = subprocess.run([sys.executable, str(ROOT / script), "again", str(number // len(TURNS))], cwd=ROOT, check=False)
        return {0: 0, DIFFERS: 1}.get(ended.returncode, 2)
    if subprocess.run([sys.executable, str(ROOT / script)], cwd=ROOT, check=False).returncode:
        return 2
    after = parts(page)[part]
    print("\n".join(difflib.unified_diff(before.splitlines(), after.splitlines(), "before", "now", n=0, lineterm="")))
    is_changed = False
    for (old, old_numbers), (new, numbers) in zip(claims(part, before), claims(part, after), strict=True):
        if has_changed(part, old_numbers, numbers):
            is_changed = True
            print(f"CHANGED: {old}\n    now: {new}")
        else:
            print(new)
    return int(is_changed)


def write():
    """Writes the claims and the heads of all pages."""
    for name, text in written().items():
        (FOLDER / name).write_text(text)


def main():
    if sys.argv[1:2] == ["--turn"]:
        sys.exit(turn(int(sys.argv[2]) if len(sys.argv) > 2 else datetime.date.today().toordinal()))
    if "--check" not in sys.argv:
        write()
        return
    wrong = [name for name, text in written().items() if (FOLDER / name).read_text() != text]
    if wrong:
        sys.exit(f"docs/evidence: {', '.join(wrong)} are not what scripts/evidence.py writes: run it")
    if quotes := list(wrong_quotes()):
        sys.exit("\n".join(quotes))
    left = {path.name for path in FOLDER.glob("*_table*.csv")}
    for page in PAGES:
        for name, count in re.findall(r"The table is in \[(\w+\.csv)\]\(\1\): (\d+) rows", (FOLDER / f"{page}.md").read_text()):
            left.discard(name)
            with open(FOLDER / name, newline="") as table:
                if len(list(csv.reader(table))) - 1 != int(count):
                    sys.exit(f"docs/evidence/{name} does not have the {count} rows that {page}.md says")
    if left:
        sys.exit(f"docs/evidence: no page names {', '.join(sorted(left))} any more: remove it")
    old = [f"{part} ({solver_of(own)})" for part, own in stamps().items() if own["solver"] < solver_version()]
    print(f"older than the solver ({solver_version()}): {', '.join(old)}")


if __name__ == "__main__":
    main()
