//! What is written about a file: a report in Markdown, a campaign with the fitted laws, and a
//! campaign that replays the encounters.
//!
//! The campaign is a template with four laws replaced, so that it says everything a campaign must;
//! what is not in the file stays as the template has it and is marked.

use crate::fit::{Fitted, fit};
use crate::meetings::{BEFORE_S, Found, Meeting, NEAR_M};
use crate::read::{Reasons, Rows};
use crate::tracks::Track;
use encounter::Distribution;
use geom::units::to_deg;
use geom::{Vec2, angle};
use record::{EncounterId, Purpose, Seed, Stream, Streams};
use std::fmt::Write as _;

/// Fewer encounters do not represent a traffic.
pub const PAIRS_MIN: usize = 200;
/// What is said then.
pub const TOO_FEW: &str = "too few encounters to represent a traffic";
/// What is said of a law whose numbers the file does not have.
pub const ABSENT: &str = "not in this file";

/// Everything that was made of a file.
#[derive(Clone, Debug)]
pub struct Model {
    /// Encounters.
    pub meetings: Vec<Meeting>,
    /// Speeds of both ships, m/s.
    pub speed: Law,
    /// Signed miss distance on the courses of the start, metres.
    pub miss: Law,
    /// Relative courses as they were, and mirrored in the roles, degrees.
    pub relative_course_deg: Vec<f64>,
    /// Lengths of the ships that met, metres.
    pub length: Law,
}

/// A sample and its law.
#[derive(Clone, Debug)]
pub struct Law {
    /// What it is called in a report.
    pub name: &'static str,
    /// The values.
    pub sample: Vec<f64>,
    /// The law; absent for a sample that is too small.
    pub fitted: Option<Fitted>,
}

impl Law {
    fn new(name: &'static str, sample: Vec<f64>, draws: &mut Stream) -> Self {
        let fitted = fit(&sample, draws);
        Self { name, sample, fitted }
    }

    /// The law as a campaign file has it; the sample itself where the fit is refuted.
    fn distribution(&self) -> Option<Distribution> {
        let fitted = self.fitted.as_ref()?;
        let refuted = fitted.p_value < REFUTED_BELOW;
        Some(if refuted {
            Distribution::Empirical(self.sample.clone())
        } else {
            fitted.distribution()
        })
    }
}

/// A law with a smaller p-value is not used: the sample takes its place.
const REFUTED_BELOW: f64 = 0.05;

/// Fits all laws. The seed serves the bootstraps alone.
pub fn model(tracks: &[Track], found: &Found, seed: Seed) -> Model {
    let stream = |j| Streams::new(seed, &EncounterId::new("fit-ais", j));
    let draws = |j| stream(j).stream(Purpose::Geometry, 0);
    let meetings = found.meetings.clone();
    let speeds = meetings.iter().flat_map(|m| m.start.map(|start| start.velocity_mps.norm()));
    let misses = meetings.iter().map(Meeting::miss_m);
    let courses = meetings.iter().flat_map(|m| {
        let course_deg = to_deg(m.relative_course_rad());
        [course_deg, -course_deg]
    });
    let mut met: Vec<usize> = meetings.iter().flat_map(|m| m.ships).collect();
    met.sort_unstable();
    met.dedup();
    let lengths = met.iter().filter_map(|&ship| tracks[ship].length_m);
    Model {
        speed: Law::new("speed, m/s", speeds.collect(), &mut draws(0)),
        miss: Law::new("miss distance, m", misses.collect(), &mut draws(1)),
        relative_course_deg: courses.collect(),
        length: Law::new("length, m", lengths.collect(), &mut draws(2)),
        meetings,
    }
}

/// The report.
pub fn report(name: &str, rows: &Rows, tracks: &[Track], found: &Found, model: &Model) -> String {
    let mut text = String::new();
    let mut line = |words: String| {
        text.push_str(&words);
        text.push('\n');
    };
    let n = model.meetings.len();
    line(format!("# {name}\n"));
    if n < PAIRS_MIN {
        line(format!("**{n} encounters: {TOO_FEW}** ({PAIRS_MIN} at least).\n"));
    }
    let [from_s, to_s] = span_s(tracks);
    line(format!("| what | how many |\n|---|---|\n| rows | {} |", rows.rows));
    line(format!("| reports used | {} |", tracks.iter().map(|t| t.points.len()).sum::<usize>()));
    line(format!("| reports without a course | {} |", rows.without_course));
    line(format!("| ships | {} |", tracks.len()));
    line(format!("| minutes from first to last report | {:.1} |", (to_s - from_s) / 60.0));
    line(format!("| pairs within {NEAR_M:.0} m, both under way | {} |", found.near));
    line(format!("| encounters | {n} |"));
    let [head_on, crossing, parallel] = kinds(&model.meetings);
    line(format!(
        "| of these head-on, crossing, near-parallel | {head_on}, {crossing}, {parallel} |"
    ));
    line("\n## Left out\n\n| why | how many | first line |\n|---|---|---|".to_owned());
    for reasons in [&rows.rejected, &found.left_out] {
        reasons_into(reasons, &mut line);
    }
    line("\n## Laws; Kolmogorov distance from the sample\n".to_owned());
    line("| of | n | law | parameters, 95 % intervals | distance | p | in the model |".to_owned());
    line("|---|---|---|---|---|---|---|".to_owned());
    for law in [&model.speed, &model.miss, &model.length] {
        line(law_row(law));
    }
    text
}

fn reasons_into(reasons: &Reasons, line: &mut impl FnMut(String)) {
    for (reason, counted) in reasons {
        let first =
            if counted.first_line > 0 { counted.first_line.to_string() } else { "-".into() };
        line(format!("| {reason} | {} | {first} |", counted.count));
    }
}

fn law_row(law: &Law) -> String {
    let Some(fitted) = &law.fitted else {
        let why = if law.sample.is_empty() { ABSENT } else { "too few values" };
        return format!("| {} | {} | {why} | | | | as the template |", law.name, law.sample.len());
    };
    let parameters: Vec<String> = fitted
        .parameters
        .iter()
        .map(|p| format!("{} {:.3} [{:.3}, {:.3}]", p.name, p.value, p.interval[0], p.interval[1]))
        .collect();
    let used = if fitted.p_value < REFUTED_BELOW { "the sample itself" } else { "the law" };
    format!(
        "| {} | {} | {:?} | {} | {:.3} | {:.3} | {used} |",
        law.name,
        fitted.n,
        fitted.form,
        parameters.join(", "),
        fitted.distance,
        fitted.p_value
    )
}

/// Within this of reciprocal courses a pair is head-on here, and within it of equal ones
/// near-parallel; the judge's classes go by bearings as well.
const ANGLE_DEG: f64 = 15.0;

fn kinds(meetings: &[Meeting]) -> [usize; 3] {
    let angle_deg = |m: &Meeting| to_deg(m.relative_course_rad()).abs();
    let count = |in_kind: &dyn Fn(f64) -> bool| {
        meetings.iter().filter(|&meeting| in_kind(angle_deg(meeting))).count()
    };
    let head_on = count(&|angle| angle >= 180.0 - ANGLE_DEG);
    let parallel = count(&|angle| angle <= ANGLE_DEG);
    [head_on, meetings.len() - head_on - parallel, parallel]
}

fn span_s(tracks: &[Track]) -> [f64; 2] {
    let times = tracks.iter().flat_map(|track| track.points.iter().map(|point| point.t_s));
    let ends = times.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], t| [a.min(t), b.max(t)]);
    if ends[0] > ends[1] { [0.0, 0.0] } else { ends }
}

/// The template with the laws of the file. Keys are replaced in their tables; a key that is not
/// there leaves the template as it is and is named in the error.
///
/// # Errors
/// The template has no such table or key.
pub fn campaign(template: &str, name: &str, model: &Model) -> Result<String, String> {
    let mut text = String::new();
    let n = model.meetings.len();
    let say = |law: &Law| if law.fitted.is_some() { "fitted" } else { ABSENT };
    writeln!(text, "# Encounter model of {name}: {n} encounters.").expect(IN_MEMORY);
    if n < PAIRS_MIN {
        writeln!(text, "# {TOO_FEW}.").expect(IN_MEMORY);
    }
    let said = [&model.speed, &model.miss, &model.length].map(|law| (law.name, say(law)));
    for (name, said) in said.into_iter().chain([("relative course", "as it was")]) {
        writeln!(text, "# {name}: {said}.").expect(IN_MEMORY);
    }
    text.push_str("# Everything else is that of the template.\n\n");
    text.push_str(template);
    let mut replace = |table: &str, key: &str, law: Option<Distribution>| match law {
        None => Ok(()),
        Some(law) => replaced(&text, table, key, &inline(&law)).map(|new| text = new),
    };
    replace("model.own", "speed_mps", model.speed.distribution())?;
    replace("model.target", "speed_mps", model.speed.distribution())?;
    replace("model.target", "length_m", model.length.distribution())?;
    replace("model.geometry", "miss_m", model.miss.distribution())?;
    let courses = (!model.relative_course_deg.is_empty())
        .then(|| Distribution::Empirical(model.relative_course_deg.clone()));
    replace("model.geometry", "relative_course_deg", courses)?;
    Ok(text)
}

const IN_MEMORY: &str = "a String takes every write";

fn replaced(text: &str, table: &str, key: &str, value: &str) -> Result<String, String> {
    let mut inside = false;
    let mut done = false;
    let lines: Vec<String> = text
        .lines()
        .map(|line| {
            if line.starts_with('[') {
                inside = line.trim() == format!("[{table}]");
            }
            let here = inside && !done && line.split('=').next().is_some_and(|k| k.trim() == key);
            done |= here;
            if here { format!("{key} = {value}") } else { line.to_owned() }
        })
        .collect();
    if done { Ok(lines.join("\n") + "\n") } else { Err(format!("`{table}.{key}` is not in it")) }
}

fn inline(law: &Distribution) -> String {
    match law {
        Distribution::Uniform([low, high]) => format!("{{ uniform = [{low:.4}, {high:.4}] }}"),
        Distribution::Normal(law) => format!(
            "{{ normal = {{ mean = {:.4}, sd = {:.4}, low = {:.4}, high = {:.4} }} }}",
            law.mean, law.sd, law.low, law.high
        ),
        Distribution::Lognormal(law) => format!(
            "{{ lognormal = {{ median = {:.4}, sigma = {:.4}, low = {:.4}, high = {:.4} }} }}",
            law.median, law.sigma, law.low, law.high
        ),
        Distribution::Empirical(values) => {
            let values: Vec<String> = values.iter().map(|value| format!("{value:.4}")).collect();
            format!("{{ empirical = [{}] }}", values.join(", "))
        }
        Distribution::Constant(value) => format!("{{ constant = {value:.4} }}"),
        Distribution::Triangular(law) => format!(
            "{{ triangular = {{ low = {:.4}, mode = {:.4}, high = {:.4} }} }}",
            law.low, law.mode, law.high
        ),
    }
}

/// The encounters as situations, one for each role: own ship takes the place of the first ship
/// and then of the second, the other goes straight on from where she was [`BEFORE_S`] before the
/// closest point. The head of the campaign is the caller's.
pub fn situations(tracks: &[Track], meetings: &[Meeting]) -> String {
    let mut text = String::new();
    for (k, meeting) in meetings.iter().enumerate() {
        for (role, [own, other]) in [[0, 1], [1, 0]].into_iter().enumerate() {
            let (start, target) = (&meeting.start[own], &meeting.start[other]);
            let origin_m = start.position_m;
            let goal_m = start.velocity_mps * (3.0 * BEFORE_S);
            let length = tracks[meeting.ships[other]].length_m;
            let length = length.map_or_else(String::new, |m| format!(", length_m = {m:.1}"));
            writeln!(
                text,
                "[[situation]]\nname = \"pair_{k:04}_{role}\"\n\
                 own = {{ {} }}\ngoal = {{ north_m = {:.2}, east_m = {:.2} }}\n\
                 targets = [ {{ {}{length} }} ]\n",
                placed(Vec2::zeros(), start.velocity_mps),
                goal_m.x,
                goal_m.y,
                placed(target.position_m - origin_m, target.velocity_mps),
            )
            .expect(IN_MEMORY);
        }
    }
    text
}

fn placed(position_m: Vec2, velocity_mps: Vec2) -> String {
    let course_deg = to_deg(angle::direction(velocity_mps));
    // thousandths of a degree from 0 up to 360, which is 0 again
    let thousandths = ((course_deg * 1000.0).round() as i64).rem_euclid(360_000);
    format!(
        "north_m = {:.2}, east_m = {:.2}, course_deg = {:.3}, speed_mps = {:.3}",
        position_m.x,
        position_m.y,
        thousandths as f64 / 1000.0,
        velocity_mps.norm()
    )
}
