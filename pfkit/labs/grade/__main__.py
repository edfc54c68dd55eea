"""The command: python -m pfkit.labs.grade lab3 submissions/ -o grades.csv"""

import argparse
import json
import sys
from collections import Counter
from pathlib import Path

from tqdm import tqdm

from pfkit.labs.grade import report, submission
from pfkit.labs.grade.batch import Batch, CannotGrade, Limits, Record
from pfkit.labs.grade.notebook import NoSuchLab, Pristine, find
from pfkit.labs.lab import Lab


def arguments(words: list[str] | None = None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m pfkit.labs.grade",
        description="Grade a folder of notebooks or exported answers; one row each. Writes the "
        "grades, and beside them statistics of the items (_items.csv), a page for each submission "
        "(_reports/) and the journal of --resume (.jsonl).",
        epilog="Exit code 0 if each submission has its row, whatever it holds. Not a sandbox: "
        "answers run with your rights. The instructor guide says more.",
    )
    add = parser.add_argument
    add("lab", help="such as lab3 or resampling")
    add("folder", type=Path, help="where the submissions lie, at any depth")
    add("-o", "--output", type=Path, default=Path("grades.csv"), help="default: %(default)s")
    add("--jobs", type=int, default=1, help="submissions at a time (default: 1)")
    add("--cell-timeout", type=float, default=60, metavar="S", help="seconds per cell (60)")
    add("--wall", type=float, default=300, metavar="S", help="seconds per submission (300)")
    add("--memory", type=float, default=4, metavar="GB", help="per submission (4)")
    add("--resume", action="store_true", help="keep what an interrupted run has graded")
    add("--notebook", type=Path, help="the unanswered notebook, if it is not this course's")
    asked = parser.parse_args(words)
    if asked.jobs < 1 or min(asked.cell_timeout, asked.wall, asked.memory) <= 0:
        parser.error("--jobs, --cell-timeout, --wall and --memory must be positive")
    if not asked.folder.is_dir():
        parser.error(f"{asked.folder} is not a folder")
    if not asked.output.absolute().parent.is_dir():
        parser.error(f"there is no folder {asked.output.absolute().parent} for the grades")
    return asked


class Journal:
    """A line of JSON per record, written when it is done: the memory of ``--resume``."""

    def __init__(self, path: Path, lab: Lab, resume: bool) -> None:
        self._path, self._lab = path, lab
        self._file = path.with_suffix(".jsonl")
        self.records: dict[str, Record] = {}
        if resume and self._file.exists():
            for line in self._file.read_text(encoding="utf-8", errors="replace").splitlines():
                self._remember(line)
        elif self._file.exists() or path.exists():
            for old in (path, self._file):
                _set_aside(old)

    def _remember(self, line: str) -> None:
        try:
            record = json.loads(line)
            self.records[record["file"]] = record
        except (ValueError, TypeError, KeyError):
            return  # the line at which the run was interrupted

    def keep(self, files: dict[str, str], version: str) -> None:
        """Forget records of files that are gone or changed, and of another version."""
        self.records = {
            name: r
            for name, r in self.records.items()
            if files.get(name) == r["sha256"] and r["version"] == version
        }
        text = "".join(json.dumps(r) + "\n" for r in self.records.values())
        report.write(self._file, text)

    def add(self, record: Record) -> None:
        self.records[record["file"]] = record
        with self._file.open("a", encoding="utf-8") as out:
            out.write(json.dumps(record) + "\n")
        self.tables()

    def tables(self) -> None:
        records = list(self.records.values())
        report.write(self._path, report.rows(records, self._lab))

    def pages(self) -> None:
        """Statistics and pages, once all is graded."""
        records = list(self.records.values())
        beside = self._path.with_suffix("")
        report.write(Path(f"{beside}_items.csv"), report.statistics(records, self._lab))
        folder = Path(f"{beside}_reports")
        folder.mkdir(exist_ok=True)
        for file, name in report.page_names(records).items():
            report.write(folder / name, report.page(self.records[file], self._lab))


def _set_aside(path: Path) -> None:
    if path.exists():
        n = 1
        while (aside := path.with_name(f"{path.stem}.before-{n}{path.suffix}")).exists():
            n += 1
        path.rename(aside)
        print(f"{path.name} was there: it is {aside.name} now", file=sys.stderr)


def grade(pristine: Pristine, asked: argparse.Namespace) -> Journal:
    """Grade what is not graded yet; the tables are right after every submission."""
    limits = Limits(asked.cell_timeout, asked.wall, int(asked.memory * 1e9))
    files = submission.collect(asked.folder)
    journal = Journal(asked.output, pristine.lab, asked.resume)
    with Batch(pristine, asked.folder, limits) as batch:
        print("rehearsal of the unanswered notebook ...", file=sys.stderr)
        seconds = batch.rehearse()
        names = {f.relative_to(asked.folder).as_posix(): f for f in files}
        prints = {n: submission.fingerprint(f) for n, f in names.items()} if asked.resume else {}
        journal.keep(prints, batch.version)
        todo = [f for n, f in names.items() if n not in journal.records]
        kept = f", {len(journal.records)} kept" if asked.resume else ""
        print(f"{seconds:.0f} s; {len(todo)} submissions to grade{kept}", file=sys.stderr)
        with tqdm(total=len(todo), unit=" submissions", disable=None) as bar:
            for record in batch.grade(todo, asked.jobs):
                journal.add(record)
                bar.set_postfix_str(f"{record['student']} {record['status']}")
                bar.update()
    journal.tables()
    journal.pages()
    return journal


def main(words: list[str] | None = None) -> int:
    """0: every submission has its row. 2: nothing could be graded. 130: interrupted."""
    asked = arguments(words)
    try:
        journal = grade(find(asked.lab, asked.notebook), asked)
    except (NoSuchLab, CannotGrade, OSError) as error:
        print(f"pfkit.labs.grade: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("\ninterrupted; the same command with --resume goes on", file=sys.stderr)
        return 130
    counts = Counter(r["status"] for r in journal.records.values())
    told = ", ".join(f"{n} {status}" for status, n in counts.most_common()) or "no submissions"
    print(f"{asked.output}: {told}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
