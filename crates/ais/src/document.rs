//! What is found in a file: the laws of its encounters, and a report in Markdown.

use crate::fit::{Fitted, fit};
use crate::meetings::{Found, MOVING_MPS, Meeting, NEAR_M};
use crate::read::{Reasons, Rows};
use crate::tracks::Track;
use encounter::Distribution;
use geom::units::to_deg;
use record::{EncounterId, Purpose, Seed, Stream, Streams};

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
    /// Time to the closest point on the courses of the start, seconds.
    pub time: Law,
    /// Distances at the start, metres.
    pub start_range_m: Vec<f64>,
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
    /// Values that come in blocks of `together` (both ships of an encounter) stay together when
    /// the sample is drawn again.
    fn new(name: &'static str, sample: Vec<f64>, together: usize, draws: &mut Stream) -> Self {
        let fitted = fit(&sample, together, draws);
        Self { name, sample, fitted }
    }

    /// The law as a campaign file has it; the sample itself where the fit is refuted.
    pub(crate) fn distribution(&self) -> Option<Distribution> {
        let fitted = self.fitted.as_ref()?;
        Some(if self.is_refuted() {
            Distribution::Empirical(thinned(&self.sample))
        } else {
            fitted.distribution()
        })
    }
}

impl Law {
    /// Whether the sample itself takes the law's place.
    pub fn is_refuted(&self) -> bool {
        self.fitted.as_ref().is_some_and(|fitted| fitted.p_value < REFUTED_BELOW)
    }
}

/// A law with a smaller p-value is not used: the sample takes its place.
const REFUTED_BELOW: f64 = 0.05;
/// As many values of a large sample are written.
const VALUES_MAX: usize = 400;

/// The sample, or as many of its quantiles as a file can hold.
pub(crate) fn thinned(sample: &[f64]) -> Vec<f64> {
    let mut sorted = sample.to_vec();
    if sorted.len() <= VALUES_MAX {
        return sorted;
    }
    sorted.sort_by(f64::total_cmp);
    let at = |k: usize| (2 * k + 1) * sorted.len() / (2 * VALUES_MAX);
    (0..VALUES_MAX).map(|k| sorted[at(k)]).collect()
}

/// Fits all laws. The seed serves the bootstraps alone.
pub fn model(tracks: &[Track], found: &Found, seed: Seed) -> Model {
    let stream = |j| Streams::new(seed, &EncounterId::new("fit-ais", j));
    let draws = |j| stream(j).stream(Purpose::Geometry, 0);
    let meetings = found.meetings.clone();
    let speeds = meetings.iter().flat_map(|m| m.start.map(|start| start.velocity_mps.norm()));
    let misses = meetings.iter().map(Meeting::miss_m);
    let times = meetings.iter().map(Meeting::tcpa_s);
    let ranges = meetings.iter().map(Meeting::start_range_m);
    let courses = meetings.iter().flat_map(|m| {
        let course_deg = to_deg(m.relative_course_rad());
        [course_deg, -course_deg]
    });
    let mut met: Vec<usize> = meetings.iter().flat_map(|m| m.ships).collect();
    met.sort_unstable();
    met.dedup();
    let lengths = met.iter().filter_map(|&ship| tracks[ship].length_m);
    Model {
        speed: Law::new("speed, m/s", speeds.collect(), 2, &mut draws(0)),
        miss: Law::new("miss distance, m", misses.collect(), 1, &mut draws(1)),
        relative_course_deg: courses.collect(),
        length: Law::new("length, m", lengths.collect(), 1, &mut draws(2)),
        time: Law::new("time to the closest point, s", times.collect(), 1, &mut draws(3)),
        start_range_m: ranges.collect(),
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
    line(format!("| reports without a heading | {} |", heading(rows)));
    line(format!("| ships | {} |", tracks.len()));
    let moves = |track: &&Track| track.points.iter().any(|point| point.sog_mps > MOVING_MPS);
    line(format!("| of these ever over two knots | {} |", tracks.iter().filter(moves).count()));
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
    for law in [&model.speed, &model.miss, &model.time, &model.length] {
        line(law_row(law));
    }
    text
}

fn heading(rows: &Rows) -> String {
    match rows.columns.heading {
        Some(_) => rows.without_heading.to_string(),
        None => ABSENT.to_owned(),
    }
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
    let used = if law.is_refuted() { "the sample itself" } else { "the law" };
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
