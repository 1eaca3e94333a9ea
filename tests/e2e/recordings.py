"""Reads every recording of a folder with the reader of the format's authors.

Checks the checksums, the number of messages, that every message fits the schema beside it, and that
each ship's frame moves. Usage: recordings.py FOLDER
"""

import json
import sys
from pathlib import Path

import jsonschema
from mcap.reader import make_reader

WANTED = {"foxglove.SceneUpdate", "foxglove.FrameTransforms", "foxglove.LocationFix"}


def check(path: Path) -> int:
    with path.open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        summary = reader.get_summary()
        validators, names, places, count = {}, set(), {}, 0
        for schema, _, message in reader.iter_messages():
            data = json.loads(message.data)
            if schema.id not in validators:
                validators[schema.id] = jsonschema.Draft202012Validator(json.loads(schema.data))
            validators[schema.id].validate(data)
            names.add(schema.name)
            count += 1
            for transform in data.get("transforms", []):
                place = transform["translation"]
                places.setdefault(transform["child_frame_id"], set()).add((place["x"], place["y"]))
        metadata = {key: value for m in reader.iter_metadata() for key, value in m.metadata.items()}
    assert count == summary.statistics.message_count > 0, path
    assert WANTED <= names, (path, names)
    assert metadata["encounter"].replace("/", "-") == path.stem, (path, metadata)
    assert len(places["own_ship"]) > 1, path
    return count


def main() -> None:
    paths = sorted(Path(sys.argv[1]).glob("*.mcap"))
    assert paths, "there is no recording"
    messages = sum(check(path) for path in paths)
    print(f"e2e: {len(paths)} recordings with {messages} messages are read")


main()
