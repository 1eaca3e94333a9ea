//! JSON Schemas of the messages in a recording: those of Foxglove that a viewer knows by name
//! (`foxglove.*`, <https://docs.foxglove.dev/docs/sdk/schemas>), with the fields that a recording
//! fills and all that they require, and two of our own for plots.

use serde_json::{Map, Value, json};

fn object(title: &str, fields: &[(&str, Value)]) -> Value {
    let properties: Map<String, Value> =
        fields.iter().map(|(name, schema)| ((*name).to_owned(), schema.clone())).collect();
    let required: Vec<&str> = fields.iter().map(|(name, _)| *name).collect();
    json!({ "title": title, "type": "object", "properties": properties, "required": required })
}

fn number() -> Value {
    json!({ "type": "number" })
}

fn text() -> Value {
    json!({ "type": "string" })
}

fn boolean() -> Value {
    json!({ "type": "boolean" })
}

fn list(items: &Value) -> Value {
    json!({ "type": "array", "items": items })
}

/// An enumeration of Foxglove's: the values from 0 on, by name.
fn choice(title: &str, names: &[&str]) -> Value {
    let values: Vec<Value> = (names.iter().enumerate())
        .map(|(value, name)| json!({ "title": name, "const": value }))
        .collect();
    json!({ "title": title, "oneOf": values })
}

fn clock(title: &str) -> Value {
    let nsec = json!({ "type": "integer", "minimum": 0, "maximum": 999_999_999 });
    object(title, &[("sec", json!({ "type": "integer" })), ("nsec", nsec)])
}

fn vector(title: &str) -> Value {
    object(title, &[("x", number()), ("y", number()), ("z", number())])
}

fn quaternion() -> Value {
    let fields = [("x", number()), ("y", number()), ("z", number()), ("w", number())];
    object("foxglove.Quaternion", &fields)
}

fn colour() -> Value {
    let fields = [("r", number()), ("g", number()), ("b", number()), ("a", number())];
    object("foxglove.Color", &fields)
}

fn pose() -> Value {
    let fields = [("position", vector("foxglove.Vector3")), ("orientation", quaternion())];
    object("foxglove.Pose", &fields)
}

fn indices() -> Value {
    list(&json!({ "type": "integer", "minimum": 0 }))
}

/// `foxglove.FrameTransforms`.
pub(crate) fn frame_transforms() -> Value {
    let transform = object(
        "foxglove.FrameTransform",
        &[
            ("timestamp", clock("time")),
            ("parent_frame_id", text()),
            ("child_frame_id", text()),
            ("translation", vector("foxglove.Vector3")),
            ("rotation", quaternion()),
        ],
    );
    object("foxglove.FrameTransforms", &[("transforms", list(&transform))])
}

/// `foxglove.LocationFix`; the optional fields are those that a map shows.
pub(crate) fn location_fix() -> Value {
    let nine = json!({
        "type": "array", "items": { "type": "number" }, "minItems": 9, "maxItems": 9,
    });
    let known = ["UNKNOWN", "APPROXIMATED", "DIAGONAL_KNOWN", "KNOWN"];
    object(
        "foxglove.LocationFix",
        &[
            ("timestamp", clock("time")),
            ("frame_id", text()),
            ("latitude", number()),
            ("longitude", number()),
            ("altitude", number()),
            ("position_covariance", nine),
            ("position_covariance_type", choice("foxglove.PositionCovarianceType", &known)),
            ("heading", number()),
            ("color", colour()),
        ],
    )
}

/// `foxglove.Log`.
pub(crate) fn log() -> Value {
    let levels = ["UNKNOWN", "DEBUG", "INFO", "WARNING", "ERROR", "FATAL"];
    object(
        "foxglove.Log",
        &[
            ("timestamp", clock("time")),
            ("level", choice("foxglove.LogLevel", &levels)),
            ("message", text()),
            ("name", text()),
            ("file", text()),
            ("line", json!({ "type": "integer", "minimum": 0 })),
        ],
    )
}

/// `foxglove.SceneUpdate`. Kinds of shapes that no recording has are lists of anything.
pub(crate) fn scene_update() -> Value {
    let deletion = object(
        "foxglove.SceneEntityDeletion",
        &[
            ("timestamp", clock("time")),
            ("type", choice("foxglove.SceneEntityDeletionType", &["MATCHING_ID", "ALL"])),
            ("id", text()),
        ],
    );
    let pair = object("foxglove.KeyValuePair", &[("key", text()), ("value", text())]);
    let none = list(&json!({ "type": "object" }));
    let entity = object(
        "foxglove.SceneEntity",
        &[
            ("timestamp", clock("time")),
            ("frame_id", text()),
            ("id", text()),
            ("lifetime", clock("duration")),
            ("frame_locked", boolean()),
            ("metadata", list(&pair)),
            ("arrows", none.clone()),
            ("cubes", none.clone()),
            ("spheres", none.clone()),
            ("cylinders", none.clone()),
            ("lines", list(&line_primitive())),
            ("triangles", list(&triangle_primitive())),
            ("texts", list(&text_primitive())),
            ("models", none),
        ],
    );
    let fields = [("deletions", list(&deletion)), ("entities", list(&entity))];
    object("foxglove.SceneUpdate", &fields)
}

fn line_primitive() -> Value {
    let kinds = ["LINE_STRIP", "LINE_LOOP", "LINE_LIST"];
    object(
        "foxglove.LinePrimitive",
        &[
            ("type", choice("foxglove.LineType", &kinds)),
            ("pose", pose()),
            ("thickness", number()),
            ("scale_invariant", boolean()),
            ("points", list(&vector("foxglove.Point3"))),
            ("color", colour()),
            ("colors", list(&colour())),
            ("indices", indices()),
        ],
    )
}

fn triangle_primitive() -> Value {
    object(
        "foxglove.TriangleListPrimitive",
        &[
            ("pose", pose()),
            ("points", list(&vector("foxglove.Point3"))),
            ("color", colour()),
            ("colors", list(&colour())),
            ("indices", indices()),
        ],
    )
}

fn text_primitive() -> Value {
    object(
        "foxglove.TextPrimitive",
        &[
            ("pose", pose()),
            ("billboard", boolean()),
            ("font_size", number()),
            ("scale_invariant", boolean()),
            ("color", colour()),
            ("text", text()),
        ],
    )
}

fn number_or_null() -> Value {
    json!({ "type": ["number", "null"] })
}

/// Our own: a ship over time, for plots.
pub(crate) fn ship() -> Value {
    object(
        "seatrial.Ship",
        &[
            ("north_m", number()),
            ("east_m", number()),
            ("heading_deg", number()),
            ("course_deg", number()),
            ("speed_mps", number()),
            ("ordered_course_deg", number_or_null()),
            ("ordered_speed_mps", number_or_null()),
        ],
    )
}

/// Our own: own ship against one target over time.
pub(crate) fn pair() -> Value {
    object(
        "seatrial.Pair",
        &[
            ("hull_distance_m", number()),
            ("centre_distance_m", number()),
            ("predicted_cpa_m", number()),
            ("time_to_cpa_s", number_or_null()),
            ("risk_stage", json!({ "type": "integer", "minimum": 0, "maximum": 5 })),
            ("state", text()),
        ],
    )
}
