//! Files appear whole or not at all.

use crate::input::{Case, Compared, ReportInput};
use crate::{ReportError, case_figure, compare, figure_scene, page};
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

/// A file of a report before it is written, with its path inside the folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rendered {
    /// Relative to the folder, such as `figures/cpa.svg`.
    pub path: PathBuf,
    /// What is in it.
    pub text: String,
}

/// Renders a report without writing it: the same input gives the same bytes.
///
/// # Errors
/// A template does not fit its data.
pub fn render(input: &ReportInput) -> Result<Vec<Rendered>, ReportError> {
    let figures = page::figures(input);
    let text = page::page(input, &figures)?;
    let mut files = vec![Rendered { path: "report.html".into(), text }];
    let scenes = input.scenes.iter().map(figure_scene::figure);
    files.extend(figures.into_iter().chain(scenes).filter_map(|figure| {
        let path = Path::new("figures").join(format!("{}.svg", figure.stem));
        figure.svg.map(|text| Rendered { path, text })
    }));
    Ok(files)
}

/// Writes `report.html` and `figures/*.svg` into `dir`. Returns the paths written.
///
/// # Errors
/// The folder cannot be written, or a template does not fit its data.
pub fn write(dir: &Path, input: &ReportInput) -> Result<Vec<PathBuf>, ReportError> {
    put_all(dir, render(input)?)
}

/// Writes the side-by-side of several planners, `comparison.html` and its figure, into `dir`.
///
/// # Errors
/// As [`write`].
pub fn write_comparison(dir: &Path, columns: &[Compared]) -> Result<Vec<PathBuf>, ReportError> {
    put_all(dir, compare::render(columns)?)
}

/// Draws one encounter as an SVG file.
///
/// # Errors
/// The file cannot be written.
pub fn draw_case(path: &Path, case: &Case) -> Result<(), ReportError> {
    put(path, &case_picture(case))
}

/// The picture of one encounter as SVG; one without a track says so.
pub fn case_picture(case: &Case) -> String {
    use crate::canvas::{At, Ink, Type, sheet};
    case_figure::figure(case).svg.unwrap_or_else(|| {
        let text = format!("{}: this run left no track", case.row.id);
        sheet(500.0, 60.0, &text, |sheet| {
            sheet.text(&text, 250.0, 30.0, Type::new(13.0, Ink::Muted, At::Middle));
        })
    })
}

fn put_all(dir: &Path, files: Vec<Rendered>) -> Result<Vec<PathBuf>, ReportError> {
    files
        .into_iter()
        .map(|file| {
            let path = dir.join(file.path);
            put(&path, &file.text)?;
            Ok(path)
        })
        .collect()
}

fn put(path: &Path, text: &str) -> Result<(), ReportError> {
    let fail = |action, path: &Path| {
        let path = path.to_owned();
        move |source| ReportError::Io { action, path, source }
    };
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(fail("make", folder))?;
    }
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".partial");
    let temporary = path.with_file_name(name);
    let written = File::create(&temporary)
        .and_then(|mut file| file.write_all(text.as_bytes()).and_then(|()| file.sync_all()));
    if let Err(source) = written {
        // Half a file is worth nothing; that it stays is no second error.
        let _ = fs::remove_file(&temporary);
        return Err(fail("write", path)(source));
    }
    fs::rename(&temporary, path).map_err(fail("rename", &temporary))
}
