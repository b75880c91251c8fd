"""The files that a model of a folder names: includes, meshes, pictures."""

from __future__ import annotations

import os
import re
from pathlib import Path

#: The bytes of all files of a model.
_MOST_BYTES = 64 << 20
_NAMED = re.compile(rb"""\bfile\s*=\s*(?:"([^"]+)"|'([^']+)')""")
_FOLDERS = re.compile(rb"""\b(?:meshdir|texturedir|assetdir)\s*=\s*(?:"([^"]+)"|'([^']+)')""")


def files_of(xml: str, folder: Path) -> dict[str, bytes]:
    """The files below a folder that a model names, and those that these name, by their paths from the folder.

    ``ValueError`` if they have too many bytes.
    """
    folder = folder.resolve()
    found: dict[str, bytes] = {}
    left, size, places = [xml.encode()], 0, {""}
    while left:
        text = left.pop()
        places |= {_text(match) for match in _FOLDERS.finditer(text)}
        for name in [_text(match) for match in _NAMED.finditer(text)]:
            for path in {os.path.normpath(os.path.join(place, name)) for place in places}:
                file = (folder / path).resolve()
                if path in found or not file.is_relative_to(folder) or not file.is_file():
                    continue
                size += file.stat().st_size
                if size > _MOST_BYTES:
                    raise ValueError(f"the files of a model have more than {_MOST_BYTES} bytes")
                found[path] = file.read_bytes()
                if file.suffix == ".xml":
                    left.append(found[path])
    return found


def _text(match: re.Match[bytes]) -> str:
    return (match[1] or match[2]).decode(errors="replace")
