//! The columns: one list that the writer and the reader share, so that they cannot part.
//!
//! Names are the field names of [`RunRow`], units included. A reaction is two columns, its word
//! and its seconds; a check is two, `<check>_status` and `<check>_margin`.

use record::{
    Check, CheckCell, Digest, EncounterClass, EncounterId, Outcome, PlannerEvents, Reaction,
    RunRow, Status,
};

/// One column: how a cell is taken from a row and put back.
pub(crate) struct Column {
    pub(crate) name: &'static str,
    /// Every row has a value.
    pub(crate) required: bool,
    pub(crate) cells: Cells,
}

/// The kind of a column. Setters of words say whether they know the word.
pub(crate) enum Cells {
    Number(fn(&RunRow) -> Option<f64>, fn(&mut RunRow, f64)),
    Count(fn(&RunRow) -> Option<u64>, fn(&mut RunRow, u64)),
    Flag(fn(&RunRow) -> Option<bool>, fn(&mut RunRow, bool)),
    Word(fn(&RunRow) -> Option<&str>, fn(&mut RunRow, &str) -> bool),
}

/// The names of all columns in their order.
pub fn column_names() -> Vec<String> {
    let fixed = COLUMNS.iter().map(|column| column.name.to_owned());
    let checks = Check::ALL.into_iter().flat_map(|check| [status_name(check), margin_name(check)]);
    std::iter::once(ID.to_owned()).chain(fixed).chain(checks).collect()
}

/// The id as text, for people and for `replay`; the reader takes `stratum` and `j`.
pub(crate) const ID: &str = "id";
pub(crate) const STRATUM: &str = "stratum";
pub(crate) const J: &str = "j";

pub(crate) fn status_name(check: Check) -> String {
    format!("{}_status", check.name())
}

pub(crate) fn margin_name(check: Check) -> String {
    format!("{}_margin", check.name())
}

/// A row before its cells are put in. Every required column overwrites its placeholder.
pub(crate) fn blank_row() -> RunRow {
    RunRow {
        id: EncounterId::new("", 0),
        outcome: Outcome::Invalid,
        digest: Digest(0),
        weight: f64::NAN,
        targets: 0,
        class: None,
        class_by_planner: None,
        fails_by_planner_class: None,
        ambiguous: false,
        intents: String::new(),
        sensing: String::new(),
        own_speed_mps: f64::NAN,
        target_speed_mps: None,
        target_length_m: None,
        beta_rad: None,
        alpha_rad: None,
        range_m: None,
        miss_m: None,
        tcpa_s: None,
        end_s: f64::NAN,
        cpa_hull_m: None,
        cpa_centre_m: None,
        cpa_s: None,
        unknown: false,
        safety_radius_broken: false,
        nominal_cpa_hull_m: None,
        nominal_safety_radius_broken: None,
        unavoidable: None,
        risk_s: None,
        reaction: Reaction::NoRisk,
        apparent: Reaction::NoRisk,
        first_turn_rad: None,
        extra_distance_m: None,
        goal_reached: false,
        impact_mps: None,
        impulse_ns: None,
        energy_lost_j: None,
        events: PlannerEvents::default(),
        planner_detail: None,
        checks: vec![CheckCell { status: Status::NotEvaluated, margin: None }; Check::COUNT],
        judges_disagree: None,
    }
}

macro_rules! required {
    ($kind:ident $field:ident) => {
        Column {
            name: stringify!($field),
            required: true,
            cells: Cells::$kind(|row| Some(row.$field), |row, value| row.$field = value),
        }
    };
}

macro_rules! optional {
    ($kind:ident $field:ident) => {
        Column {
            name: stringify!($field),
            required: false,
            cells: Cells::$kind(|row| row.$field, |row, value| row.$field = Some(value)),
        }
    };
}

macro_rules! text {
    ($field:ident) => {
        Column {
            name: stringify!($field),
            required: true,
            cells: Cells::Word(
                |row| Some(&row.$field),
                |row, text| {
                    row.$field = text.to_owned();
                    true
                },
            ),
        }
    };
}

macro_rules! optional_text {
    ($field:ident) => {
        Column {
            name: stringify!($field),
            required: false,
            cells: Cells::Word(
                |row| row.$field.as_deref(),
                |row, words| {
                    row.$field = Some(words.to_owned());
                    true
                },
            ),
        }
    };
}

macro_rules! class {
    ($field:ident) => {
        Column {
            name: stringify!($field),
            required: false,
            cells: Cells::Word(
                |row| row.$field.map(EncounterClass::name),
                |row, word| {
                    row.$field = EncounterClass::from_name(word);
                    row.$field.is_some()
                },
            ),
        }
    };
}

macro_rules! event {
    ($name:literal $field:ident) => {
        Column {
            name: $name,
            required: true,
            cells: Cells::Count(
                |row| Some(u64::from(row.events.$field)),
                |row, value| row.events.$field = u32::try_from(value).unwrap_or(u32::MAX),
            ),
        }
    };
}

macro_rules! reaction_word {
    ($field:ident) => {
        Column {
            name: stringify!($field),
            required: true,
            cells: Cells::Word(
                |row| Some(reaction_name(row.$field)),
                |row, word| reaction_from_name(word).map(|found| row.$field = found).is_some(),
            ),
        }
    };
}

macro_rules! reaction_time {
    ($name:literal $field:ident) => {
        Column {
            name: $name,
            required: false,
            cells: Cells::Number(
                |row| match row.$field {
                    Reaction::After(time_s) => Some(time_s),
                    _ => None,
                },
                |row, time_s| {
                    if let Reaction::After(at) = &mut row.$field {
                        *at = time_s;
                    }
                },
            ),
        }
    };
}

pub(crate) const COLUMNS: &[Column] = &[
    Column {
        name: STRATUM,
        required: true,
        cells: Cells::Word(
            |row| Some(&row.id.stratum),
            |row, word| {
                row.id.stratum = word.into();
                true
            },
        ),
    },
    Column {
        name: J,
        required: true,
        cells: Cells::Count(|row| Some(row.id.j), |row, j| row.id.j = j),
    },
    Column {
        name: "outcome",
        required: true,
        cells: Cells::Word(
            |row| Some(row.outcome.name()),
            |row, word| Outcome::from_name(word).map(|found| row.outcome = found).is_some(),
        ),
    },
    Column {
        name: "digest",
        required: true,
        cells: Cells::Count(|row| Some(row.digest.0), |row, bits| row.digest = Digest(bits)),
    },
    required!(Number weight),
    Column {
        name: "targets",
        required: true,
        cells: Cells::Count(
            |row| Some(u64::from(row.targets)),
            |row, count| row.targets = u8::try_from(count).unwrap_or(u8::MAX),
        ),
    },
    class!(class),
    class!(class_by_planner),
    optional_text!(fails_by_planner_class),
    required!(Flag ambiguous),
    text!(intents),
    text!(sensing),
    required!(Number own_speed_mps),
    optional!(Number target_speed_mps),
    optional!(Number target_length_m),
    optional!(Number beta_rad),
    optional!(Number alpha_rad),
    optional!(Number range_m),
    optional!(Number miss_m),
    optional!(Number tcpa_s),
    required!(Number end_s),
    optional!(Number cpa_hull_m),
    optional!(Number cpa_centre_m),
    optional!(Number cpa_s),
    required!(Flag unknown),
    required!(Flag safety_radius_broken),
    optional!(Number nominal_cpa_hull_m),
    optional!(Flag nominal_safety_radius_broken),
    optional!(Flag unavoidable),
    optional!(Number risk_s),
    reaction_word!(reaction),
    reaction_time!("reaction_s" reaction),
    reaction_word!(apparent),
    reaction_time!("apparent_s" apparent),
    optional!(Number first_turn_rad),
    optional!(Number extra_distance_m),
    required!(Flag goal_reached),
    optional!(Number impact_mps),
    optional!(Number impulse_ns),
    optional!(Number energy_lost_j),
    event!("events_inner_loop_cap" inner_loop_cap),
    event!("events_limited" limited),
    event!("events_inside_called_safe" inside_called_safe),
    event!("events_class_changes" class_changes),
    event!("events_receding_flagged" receding_flagged),
    event!("events_passes" passes),
    optional_text!(planner_detail),
    optional!(Flag judges_disagree),
];

fn reaction_name(reaction: Reaction) -> &'static str {
    match reaction {
        Reaction::NoRisk => "no_risk",
        Reaction::Early => "early",
        Reaction::After(_) => "after",
        Reaction::Never => "never",
        Reaction::Unknown => "unknown",
    }
}

fn reaction_from_name(word: &str) -> Option<Reaction> {
    Some(match word {
        "no_risk" => Reaction::NoRisk,
        "early" => Reaction::Early,
        // The seconds stand in a column of their own and are put in after the word.
        "after" => Reaction::After(f64::NAN),
        "never" => Reaction::Never,
        "unknown" => Reaction::Unknown,
        _ => return None,
    })
}
