//! `fit-ais`: an encounter model from a file of AIS reports.

use crate::embedded;
use crate::exit::Ended;
use crate::say::{say, say_text};
use ::campaign::Error;
use ais::document::{self, ABSENT, Law, Model};
use ais::meetings::Found;
use ais::model_file::{self, Source};
use ais::replay;
use ais::tracks::{GAP_S_MAX, Track};
use ais::{ColumnsError, Rows};
use record::Seed;
use report::{Sample, Traffic};
use std::fs::{self, File};
use std::io::{self, BufRead as _, BufReader};
use std::path::{Path, PathBuf};

/// The campaign whose laws are replaced.
const TEMPLATE: &str = "open-sea";

pub(super) fn run(file: &Path, out: Option<&Path>, seed: u64) -> Result<Ended, Error> {
    let cannot = |what: &str, path: &Path, e: &dyn std::fmt::Display| {
        Error::input(format!("cannot {what} {}: {e}", path.display()))
    };
    let (mut rows, blake3) = read(file, &cannot)?;
    let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let out = out.map_or_else(|| PathBuf::from(format!("reports/ais-{stem}")), Path::to_owned);
    let source = Source {
        name: file.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        blake3,
        tool: format!("seatrial {}", env!("CARGO_PKG_VERSION")),
        seed,
        template: TEMPLATE.to_owned(),
    };
    let tracks = ais::tracks(&rows.reports, &mut rows.rejected);
    let found = ais::meetings(&tracks);
    let model = document::model(&tracks, &found, Seed(seed));
    let report = document::report(&source.name, &rows, &tracks, &found, &model);
    say_text!("{report}");
    let template = embedded::campaign_text(TEMPLATE)?;
    let wrong = |e: String| Error::Fault(format!("the template {TEMPLATE}: {e}"));
    let campaign = model_file::campaign(&template, &source, &model).map_err(wrong)?;
    let replay = replay::replay(&template, &source, &tracks, &found.meetings).map_err(wrong)?;
    let picture = report::traffic_picture(&picture(&source.name, &tracks, &found, &model));
    fs::create_dir_all(&out).map_err(|e| cannot("make", &out, &e))?;
    let files = [
        ("fit.md", Some(report)),
        ("model.toml", (!found.meetings.is_empty()).then_some(campaign)),
        ("situations.toml", replay),
        ("traffic.svg", Some(picture)),
    ];
    for (name, text) in files {
        let path = out.join(name);
        match text {
            Some(text) => {
                fs::write(&path, text).map_err(|e| cannot("write", &path, &e))?;
                say!("{}", path.display());
            }
            None => say!("{}: not written, there is no encounter", path.display()),
        }
    }
    Ok(Ended::Done)
}

/// The rows of a file and its hash. A day of a country does not fit into memory as text.
fn read(
    file: &Path,
    cannot: &dyn Fn(&str, &Path, &dyn std::fmt::Display) -> Error,
) -> Result<(Rows, String), Error> {
    let cannot_read = |e: io::Error| cannot("read", file, &e);
    let mut bytes = BufReader::with_capacity(1 << 20, File::open(file).map_err(cannot_read)?);
    let mut hash = blake3::Hasher::new();
    let (mut line, mut rows) = (Vec::new(), None);
    while bytes.read_until(b'\n', &mut line).map_err(cannot_read)? > 0 {
        hash.update(&line);
        // names of ships are in any encoding, and none of them is used
        let text = String::from_utf8_lossy(&line);
        match &mut rows {
            None => rows = Some(Rows::under(&text).map_err(|e| cannot("use", file, &e))?),
            Some(rows) => rows.take(&text),
        }
        line.clear();
    }
    let rows = rows.ok_or_else(|| cannot("use", file, &ColumnsError::Empty))?;
    Ok((rows, hash.finalize().to_hex().to_string()))
}

fn picture(name: &str, tracks: &[Track], found: &Found, model: &Model) -> Traffic {
    let pieces = tracks.iter().flat_map(|track| {
        track
            .points
            .chunk_by(|a, b| b.t_s - a.t_s <= GAP_S_MAX)
            .map(|piece| piece.iter().map(|point| point.position_m).collect())
    });
    let closest = found
        .meetings
        .iter()
        .filter_map(|meeting| tracks[meeting.ships[0]].at(meeting.cpa_s).map(|at| at.position_m));
    let course = Sample {
        name: "relative course, degrees".to_owned(),
        values: model.relative_course_deg.clone(),
        law: Vec::new(),
        note: "as it was, in both roles".to_owned(),
    };
    let mut samples: Vec<Sample> =
        [&model.speed, &model.miss, &model.time, &model.length].map(sample).into();
    samples.insert(2, course);
    Traffic {
        name: name.to_owned(),
        ships: tracks.len(),
        tracks: pieces.collect(),
        closest_m: closest.collect(),
        samples,
    }
}

/// A sample with the density of its law.
fn sample(law: &Law) -> Sample {
    const POINTS: usize = 120;
    let note = match &law.fitted {
        None if law.sample.is_empty() => ABSENT.to_owned(),
        None => "too few values".to_owned(),
        Some(fitted) => {
            let refuted = if law.is_refuted() { ": refuted, the sample is used" } else { "" };
            format!("{:?}, p = {:.3}{refuted}", fitted.form, fitted.p_value)
        }
    };
    let density = law.fitted.iter().flat_map(|fitted| {
        let [low, high] = fitted.range;
        (0..=POINTS).map(move |k| {
            let x = low + (high - low) * k as f64 / POINTS as f64;
            (x, fitted.density(x))
        })
    });
    Sample { name: law.name.to_owned(), values: law.sample.clone(), law: density.collect(), note }
}

#[cfg(test)]
mod tests {
    use super::*;
    use record::Vessel;

    /// A faster own speed would be drawn and could not be sailed: such a run is invalid.
    #[test]
    fn own_ship_can_sail_what_a_model_draws() {
        let template: toml::Table = embedded::campaign_text(TEMPLATE).unwrap().parse().unwrap();
        let name = template["model"]["own"]["vessel"].as_str().unwrap().to_owned();
        let limits = sim::limits(&Vessel::Model(name)).unwrap();
        assert!(model_file::OWN_MPS_MAX <= limits.speed_mps_max, "{}", limits.speed_mps_max);
    }
}
