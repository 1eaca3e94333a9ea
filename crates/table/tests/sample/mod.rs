//! Rows that hold everything a row can hold.

use record::{
    Check, CheckCell, Digest, EncounterClass, EncounterId, Outcome, PlannerEvents, Reaction,
    RunRow, Status,
};

/// A row whose every field depends on `j`; absent values, words and signs take turns.
pub(crate) fn row(stratum: &str, j: u64) -> RunRow {
    let x = j as f64 + 0.1;
    let some = |shift: u64| (!(j + shift).is_multiple_of(3)).then_some(x * (shift as f64 - 3.5));
    let flag = |shift: u64| [None, Some(false), Some(true)][((j + shift) % 3) as usize];
    let reaction = |shift: u64| match (j + shift) % 5 {
        0 => Reaction::NoRisk,
        1 => Reaction::Early,
        2 => Reaction::After(x),
        3 => Reaction::Never,
        _ => Reaction::Unknown,
    };
    RunRow {
        id: EncounterId::new(stratum, j),
        outcome: Outcome::ALL[(j % 11) as usize],
        digest: Digest(u64::MAX - j * 0x9e37_79b9),
        weight: 1.0 / (1.0 + x),
        targets: (j % 256) as u8,
        class: EncounterClass::ALL.get((j % 7) as usize).copied(),
        class_by_planner: [None, Some(EncounterClass::HeadOn)][(j % 2) as usize],
        fails_by_planner_class: [Some("turn+r14".to_owned()), None][(j % 2) as usize].clone(),
        ambiguous: j.is_multiple_of(2),
        intents: ["", "hold_course", "complies+neglects"][(j % 3) as usize].to_owned(),
        sensing: ["perfect", "ais_radar"][(j % 2) as usize].to_owned(),
        own_speed_mps: x,
        target_speed_mps: some(0),
        target_length_m: some(1),
        beta_rad: some(2),
        alpha_rad: some(3),
        range_m: some(4),
        miss_m: some(5),
        tcpa_s: some(6),
        end_s: 2.0 * x,
        cpa_hull_m: some(7),
        cpa_centre_m: some(8),
        cpa_s: some(9),
        unknown: j.is_multiple_of(3),
        safety_radius_broken: j.is_multiple_of(5),
        nominal_cpa_hull_m: some(10),
        nominal_safety_radius_broken: flag(0),
        unavoidable: flag(1),
        risk_s: some(11),
        reaction: reaction(0),
        apparent: reaction(3),
        first_turn_rad: some(12),
        extra_distance_m: some(13),
        goal_reached: j.is_multiple_of(7),
        impact_mps: some(14),
        impulse_ns: some(15),
        energy_lost_j: some(16),
        planner_detail: [None, Some("said \"no\",\nand left".to_owned())][(j % 2) as usize].clone(),
        events: PlannerEvents {
            inner_loop_cap: j as u32,
            limited: j as u32 + 1,
            inside_called_safe: j as u32 + 2,
            class_changes: j as u32 + 3,
            receding_flagged: u32::MAX - j as u32,
            passes: j as u32 + 5,
        },
        checks: (0..Check::COUNT as u64)
            .map(|i| CheckCell {
                status: Status::ALL[((j + i) % 6) as usize],
                margin: some(i + 17),
            })
            .collect(),
        judges_disagree: flag(2),
    }
}
