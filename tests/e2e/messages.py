"""Every message between the bench and a planner in a process of its own fits its committed schema.

messages.py tap FOLDER COMMAND...  stands between them, hands every line on, and writes it down in a
                                   file of its own in FOLDER: a planner for `exec:`.
messages.py check SCHEMAS FOLDER   checks every line that was written down, that the lines hold what
                                   the schemas describe in all its forms, and that the schemas
                                   refuse what is none of their messages.
"""

import copy
import json
import os
import subprocess
import sys
from collections import Counter
from pathlib import Path

# What the bench says, and what a planner answers to it.
ASKED = {"hello": "hello-request", "reset": "reset", "plan": "plan"}
ANSWERED = {"hello": "hello", "ready": "ready", "order": "order"}


def tap(folder: Path, command: list) -> None:
    folder.mkdir(exist_ok=True)
    planner = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    with open(folder / f"{os.getpid()}.lines", "wb") as lines:
        for request in sys.stdin.buffer:
            planner.stdin.write(request)
            planner.stdin.flush()
            answer = planner.stdout.readline()
            if not answer:
                break
            lines.write(b">" + request + b"<" + answer)
            sys.stdout.buffer.write(answer)
            sys.stdout.buffer.flush()
    planner.stdin.close()
    sys.exit(planner.wait())


def forms(message: dict):
    """The forms of a message that a schema tells apart, as words."""
    if message["type"] == "reset":
        mission = message["mission"]
        yield "hazards" if mission["hazards"] else "no hazards"
    if message["type"] == "plan":
        yield "visual range " + ("none" if message["visual_range_m"] is None else "given")
        yield from ("track, length " + ("unknown" if t["length_m"] is None else "known")
                    for t in message["tracks"])
    if message["type"] == "order":
        yield from message["order"]
        yield from ("alert" for _ in message.get("alerts", []))


def check(schemas: Path, folder: Path) -> None:
    import jsonschema

    def validator(name: str):
        schema = json.loads((schemas / f"{name}.json").read_text())
        jsonschema.Draft202012Validator.check_schema(schema)
        return jsonschema.Draft202012Validator(schema)

    validators = {way + word: validator(name) for way, words in ((">", ASKED), ("<", ANSWERED))
                  for word, name in words.items()}
    assert len(validators) == len(list(schemas.glob("*.json"))), "a schema belongs to no message"
    counts, samples, seen = Counter(), {}, Counter()
    for path in sorted(folder.glob("*.lines")):
        for line in path.read_text().splitlines():
            message = json.loads(line[1:])
            kind = line[0] + message["type"]
            validators[kind].validate(message)
            counts[kind] += 1
            samples.setdefault(kind, message)
            seen.update(forms(message))
    assert set(counts) == set(validators), f"no message of {set(validators) - set(counts)}"
    wanted = {"hazards", "no hazards", "visual range none", "visual range given", "alert",
              "track, length unknown", "track, length known", "course_speed", "velocity_mps"}
    assert wanted <= set(seen), f"not seen: {wanted - set(seen)}"
    for kind, message in samples.items():
        required = validators[kind].schema["required"]
        assert "type" in required, kind
        for key in required:
            without, otherwise = copy.deepcopy(message), copy.deepcopy(message)
            del without[key]
            otherwise[key] = "other" if isinstance(message[key], (int, float, list, dict)) else 1.5
            for wrong in (without, otherwise):
                assert not validators[kind].is_valid(wrong) or key == "visual_range_m", wrong
    said = ", ".join(f"{count} {kind[1:]}" for kind, count in sorted(counts.items()))
    print(f"e2e: messages fit their schemas: {said}")


if sys.argv[1] == "tap":
    tap(Path(sys.argv[2]), sys.argv[3:])
else:
    check(Path(sys.argv[2]), Path(sys.argv[3]))
