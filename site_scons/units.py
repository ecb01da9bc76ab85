"""Translation units: the sources of one folder, several at a time.

Compiling a file of 200 lines takes some four seconds, three of which go into the 150,000 lines of headers before it. A
unit includes up to AT_A_TIME sources of the same folder, so that these are read once. What each source may include does
not change by that; that each header still stands alone, `./run test layers` shows.
"""

from pathlib import Path

# More of them save little; fewer make a change of one line quicker to compile.
AT_A_TIME = 9


def grouped(sources, is_alone=lambda _: False):
    """Lists of sources that become one object each, in a stable order: those of one folder, parted evenly."""
    folders = {}
    for source in sorted(map(str, sources)):
        key = source if is_alone(source) else str(Path(source).parent)
        folders.setdefault(key, []).append(source)
    return [part for together in folders.values() for part in _parted(together)]


def _parted(sources):
    parts = -(-len(sources) // AT_A_TIME)
    bounds = [len(sources) * index // parts for index in range(parts + 1)]
    return [sources[start:end] for start, end in zip(bounds, bounds[1:])]


def written(folder, sources):
    """The source that includes these, named after the first of them. It names them from where it lies, so that it is the
    same in each clone."""
    path = Path(folder, Path(sources[0]).with_suffix(".unit.cpp"))
    up = "../" * len(path.parent.parts)
    text = "".join(f'#include "{up}{source}"\n' for source in sources)
    if not path.is_file() or path.read_text() != text:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return path
