#!/usr/bin/env python3
"""A course of many labs, the same every time: `tests/speed/course.py FOLDER [N]`.

It is made of the lessons of `specs/lessons` and, where it is present, of the corpus in `../shared`. Each copy differs from the
others in its titles and in the names of its quizzes, so that no two files are alike.
"""

import json
import shutil
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parents[2]
CORPUS = HERE / "../shared/corpus"


def copy_of(path, number):
    """The text of a file, with a number that tells it from the other copies."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".md":
        return text.replace('"id": "', f'"id": "copy-{number}-') + f"\nCopy {number}.\n"
    value = json.loads(text)
    for one in value if isinstance(value, list) else [value]:
        if "questions" in one:
            one["id"] = f"copy-{number}-{one.get('id', 'quiz')}"
        else:
            one["title"] = f"{one.get('title', 'Lab')} ({number})"
    return json.dumps(value, ensure_ascii=False, indent=1)


def main():
    folder, wanted = Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 1000
    # Each lesson lies beside its own models: some names stand for two models.
    places = [("corpus", CORPUS / "labs", CORPUS / "models"), ("specs", HERE / "specs/lessons", HERE / "specs/models")]
    sources = []
    for name, lessons, models in places:
        sources += [(name, path) for path in sorted(lessons.glob("*")) if path.suffix in (".md", ".json")]
        shutil.copytree(models, folder / name / "models", dirs_exist_ok=True)
    labs = number = 0
    while labs < wanted:
        name, path = sources[number % len(sources)]
        text = copy_of(path, number)
        labs += text.count("```lab simlab") or 1
        (folder / name / f"{number:04}-{path.name}").write_text(text, encoding="utf-8")
        number += 1
    print(f"{labs} labs in {number} files")


if __name__ == "__main__":
    main()
