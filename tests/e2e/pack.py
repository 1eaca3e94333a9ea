"""Reads a pack with the tools of others: what is exported, the bill of materials, the crate.

Usage: pack.py PACK [DNV_SCHEMAS], the folder with traffic_situation.json and situation_output.json
of DNV's open maritime schema.
"""

import collections
import csv
import json
import sys
from pathlib import Path

import jsonschema
from cyclonedx.schema import SchemaVersion
from cyclonedx.validation.json import JsonStrictValidator
from mcap.reader import make_reader
from rocrate.rocrate import ROCrate


def geojson(pack: Path) -> int:
    """RFC 7946: lines and points in degrees, east first; the track begins where DNV's file says."""
    paths = sorted((pack / "exports").glob("*.geojson"))
    assert paths, "there is no GeoJSON"
    for path in paths:
        collection = json.loads(path.read_text())
        assert collection["type"] == "FeatureCollection" and collection["features"], path
        for feature in collection["features"]:
            assert feature["type"] == "Feature" and "properties" in feature, path
            kind, places = feature["geometry"]["type"], feature["geometry"]["coordinates"]
            assert kind in {"LineString", "Point", "Polygon"}, (path, kind)
            rings = {"Point": [[places]], "LineString": [places], "Polygon": places}[kind]
            for ring in rings:
                assert kind != "LineString" or len(ring) > 1, path
                assert kind != "Polygon" or (len(ring) > 3 and ring[0] == ring[-1]), path
                assert all(-180 <= p[0] <= 180 and -90 <= p[1] <= 90 for p in ring), path
        start = collection["features"][0]["geometry"]["coordinates"][0]
        other = json.loads(path.with_suffix(".dnv.json").read_text())
        place = other["ownShip"]["initial"]["position"]
        assert abs(start[0] - place["lon"]) < 1e-9 and abs(start[1] - place["lat"]) < 1e-9, path
        fix = first_fix(path.with_suffix(".mcap"))
        assert abs(start[0] - fix["longitude"]) < 1e-6, (path, start, fix)
        assert abs(start[1] - fix["latitude"]) < 1e-6, (path, start, fix)
    return len(paths)


def first_fix(path: Path) -> dict:
    with path.open("rb") as stream:
        for schema, channel, message in make_reader(stream).iter_messages():
            if schema.name == "foxglove.LocationFix" and "own" in channel.topic:
                return json.loads(message.data)
    raise AssertionError(f"{path}: own ship has no place")


def table(pack: Path) -> int:
    """A line for each encounter, as many of each outcome as the summary counts."""
    summary = json.loads((pack / "result/summary.json").read_text())
    with (pack / "exports/runs.csv").open(newline="") as stream:
        lines = list(csv.DictReader(stream, strict=True))
    assert len(lines) == summary["encounters"], (len(lines), summary["encounters"])
    assert all(None not in line and None not in line.values() for line in lines)
    counted = collections.Counter(line["outcome"] for line in lines)
    told = collections.Counter()
    for stratum in summary["strata"]:
        told.update({name: k for name, k in stratum["outcomes"].items() if k})
    assert counted == told, (counted, told)
    return len(lines)


def situations(pack: Path, schemas: Path) -> int:
    count = 0
    for ending, name in [("dnv", "traffic_situation"), ("dnv-output", "situation_output")]:
        schema = json.loads((schemas / f"{name}.json").read_text())
        validator = jsonschema.validators.validator_for(schema)(schema)
        paths = sorted((pack / "exports").glob(f"*.{ending}.json"))
        assert paths, f"there is no {ending}.json"
        for path in paths:
            validator.validate(json.loads(path.read_text()))
        count += len(paths)
    return count


def materials(pack: Path) -> int:
    text = (pack / "sbom.cdx.json").read_text()
    version = SchemaVersion.from_version(json.loads(text)["specVersion"])
    problem = JsonStrictValidator(version).validate_str(text)
    assert problem is None, problem
    return len(json.loads(text)["components"])


def crate(pack: Path) -> int:
    read = ROCrate(pack)
    assert read.name and read.description and read.datePublished and read.license
    for entity in read.data_entities:
        assert (pack / entity.id).is_file(), entity.id
    described = {entity.id for entity in read.data_entities}
    assert {"result/runs.parquet", "evidence.html", "sbom.cdx.json"} <= described, described
    return len(described)


def main() -> None:
    pack = Path(sys.argv[1])
    print(f"e2e: {geojson(pack)} GeoJSON files begin where the other exports do")
    print(f"e2e: {table(pack)} lines of CSV are those of the summary")
    print(f"e2e: CycloneDX's own validator takes a list of {materials(pack)} components")
    print(f"e2e: the RO-Crate library reads a crate of {crate(pack)} files")
    if len(sys.argv) > 2:
        count = situations(pack, Path(sys.argv[2]))
        print(f"e2e: {count} traffic situations and outputs fit DNV's schemas")
    else:
        print("e2e: NOT CHECKED against DNV's schemas: give their folder with --dnv-schemas")


main()
