//! Check of the seed planner's formulas against test vectors that were computed elsewhere.
//!
//! The file is CSV with a header line; lines that begin with `#` are comments. Inputs are
//! `V_A, alpha_deg, V_B, beta_deg, theta_deg, D, R`; every other column is compared with what the
//! functions of [`crate::zhuang`] give. An empty cell does not apply; `nan` asks for no value.

use crate::zhuang::{class, equations, strategy};
use geom::{EncounterClass, units::deg, wrap};

/// Largest error that passes, in the unit of the column.
pub const LIMIT: f64 = 1e-9;

/// Half-angle of the head-on sector in the class column.
const HEAD_ON_HALF_ANGLE_DEG: f64 = 10.0;

const NAME: &str = "name";
const INPUTS: [&str; 7] = ["V_A", "alpha_deg", "V_B", "beta_deg", "theta_deg", "D", "R"];

/// The outcome for a whole file.
#[derive(Clone, Debug, PartialEq)]
pub struct VectorReport {
    /// Rows read.
    pub rows: usize,
    /// One entry for each output column, in the order of the file.
    pub columns: Vec<ColumnError>,
}

/// The largest error of one column.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnError {
    /// The column.
    pub name: String,
    /// Cells that applied.
    pub cells: usize,
    /// Largest absolute error; angles modulo one turn; 1 for a wrong word; infinite where one side
    /// is not a number and the other is.
    pub error_max: f64,
    /// The row that has it, by name; empty if every cell is exact.
    pub worst_row: String,
}

impl VectorReport {
    /// Whether every column is within [`LIMIT`].
    pub fn passes(&self) -> bool {
        self.columns.iter().all(|column| column.error_max <= LIMIT)
    }
}

/// Why a file cannot be checked.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum VectorsError {
    /// No header line.
    #[error("the file has no header line")]
    Empty,
    /// The header lacks an input or names something unknown.
    #[error("column `{0}` is missing")]
    MissingColumn(String),
    /// A column that nobody computes.
    #[error("column `{0}` is not one that can be checked")]
    UnknownColumn(String),
    /// A row with too few or too many cells.
    #[error("line {line}: {found} cells instead of {expected}")]
    Cells {
        /// Line in the file, from 1.
        line: usize,
        /// How many there are.
        found: usize,
        /// How many the header has.
        expected: usize,
    },
    /// A cell that is not a number.
    #[error("line {line}, column `{column}`: `{text}` is not a number")]
    Number {
        /// Line in the file, from 1.
        line: usize,
        /// The column.
        column: String,
        /// What stands there.
        text: String,
    },
}

/// Compares every row of a file with the formulas.
pub fn check_vectors(csv: &str) -> Result<VectorReport, VectorsError> {
    let mut lines = csv
        .lines()
        .enumerate()
        .map(|(index, text)| (index + 1, text.trim()))
        .filter(|(_, text)| !text.is_empty() && !text.starts_with('#'));
    let (_, header) = lines.next().ok_or(VectorsError::Empty)?;
    let header: Vec<&str> = header.split(',').map(str::trim).collect();
    let place = |name: &str| header.iter().position(|column| *column == name);
    let missing = |name: &str| VectorsError::MissingColumn(name.to_owned());
    let mut inputs = [0; INPUTS.len()];
    for (slot, name) in inputs.iter_mut().zip(INPUTS) {
        *slot = place(name).ok_or_else(|| missing(name))?;
    }
    let name_at = place(NAME).ok_or_else(|| missing(NAME))?;
    let outputs: Vec<usize> =
        (0..header.len()).filter(|i| *i != name_at && !inputs.contains(i)).collect();
    let any_row = Row::new([1.0; INPUTS.len()]);
    if let Some(&unknown) = outputs.iter().find(|&&i| any_row.output(header[i]).is_none()) {
        return Err(VectorsError::UnknownColumn(header[unknown].to_owned()));
    }
    let column = |&i: &usize| ColumnError {
        name: header[i].to_owned(),
        cells: 0,
        error_max: 0.0,
        worst_row: String::new(),
    };
    let mut report = VectorReport { rows: 0, columns: outputs.iter().map(column).collect() };
    for (line, text) in lines {
        let cells: Vec<&str> = text.split(',').map(str::trim).collect();
        if cells.len() != header.len() {
            let (found, expected) = (cells.len(), header.len());
            return Err(VectorsError::Cells { line, found, expected });
        }
        let number = |i: usize| parse(cells[i], line, header[i]);
        let mut values = [0.0; INPUTS.len()];
        for (value, &i) in values.iter_mut().zip(&inputs) {
            *value = number(i)?;
        }
        let row = Row::new(values);
        report.rows += 1;
        for (&i, column) in outputs.iter().zip(&mut report.columns) {
            let Some(output) = row.output(header[i]).filter(|_| !cells[i].is_empty()) else {
                continue;
            };
            let error = match output {
                Output::Word(word) => f64::from(u8::from(word != cells[i])),
                Output::Number(value) => difference(value, number(i)?),
                Output::Angle(value) => angle_difference(value, number(i)?),
            };
            column.cells += 1;
            if error > column.error_max {
                column.error_max = error;
                cells[name_at].clone_into(&mut column.worst_row);
            }
        }
    }
    Ok(report)
}

fn parse(text: &str, line: usize, column: &str) -> Result<f64, VectorsError> {
    text.parse().map_err(|_| VectorsError::Number {
        line,
        column: column.to_owned(),
        text: text.to_owned(),
    })
}

fn difference(computed: f64, expected: f64) -> f64 {
    match (computed.is_nan(), expected.is_nan()) {
        (true, true) => 0.0,
        (false, false) => (computed - expected).abs(),
        _ => f64::INFINITY,
    }
}

fn angle_difference(computed: f64, expected: f64) -> f64 {
    if computed.is_nan() || expected.is_nan() {
        return difference(computed, expected);
    }
    wrap(computed - expected).abs()
}

enum Output {
    Number(f64),
    Angle(f64),
    Word(&'static str),
}

/// One row, with angles in radians and what several outputs share.
struct Row {
    v_a: f64,
    alpha: f64,
    v_b: f64,
    beta: f64,
    theta: f64,
    d: f64,
    r: f64,
    v_s: f64,
    v_theta: f64,
    gamma: f64,
    /// With the limit pi/2 on and inside the circle.
    mu: f64,
    flag: bool,
    class: Option<EncounterClass>,
    /// 0 where there is no collision to avoid.
    s: f64,
    dgamma: f64,
}

impl Row {
    fn new([v_a, alpha_deg, v_b, beta_deg, theta_deg, d, r]: [f64; INPUTS.len()]) -> Self {
        let (alpha, beta, theta) = (deg(alpha_deg), deg(beta_deg), deg(theta_deg));
        let (v_s, v_theta) = equations::los_rates(v_a, alpha, v_b, beta, theta);
        let (gamma, mu) = (equations::gamma(v_s, v_theta), equations::mu(r, d));
        let flag = equations::collision(v_s, gamma, mu);
        let h = deg(HEAD_ON_HALF_ANGLE_DEG);
        let class = (v_s > 0.0).then(|| class::sector(alpha, v_b, beta, theta, h));
        let (s, dgamma) = match class {
            Some(class) if flag => {
                let s = strategy::paper_side(class, alpha, beta);
                (s, equations::dgamma(s, mu, gamma))
            }
            _ => (0.0, 0.0),
        };
        Self { v_a, alpha, v_b, beta, theta, d, r, v_s, v_theta, gamma, mu, flag, class, s, dgamma }
    }

    fn output(&self, column: &str) -> Option<Output> {
        use Output::{Angle, Number, Word};
        let Self { v_a, alpha, v_b, beta, theta, d, .. } = *self;
        let dv = equations::dv(v_a, alpha, v_b, beta);
        let phi = equations::phi(v_a, alpha, v_b, beta);
        Some(match column {
            "V_s" => Number(self.v_s),
            "V_theta" => Number(self.v_theta),
            "dV" => Number(dv),
            "phi_heading_dV" => Angle(phi),
            "varphi" => Angle(equations::varphi(alpha, phi)),
            "gamma" => Angle(self.gamma),
            "mu" => Number(equations::mu_as_printed(self.r, d)),
            "collision_flag" => Number(f64::from(u8::from(self.flag))),
            "class" => Word(self.class.map_or("none", EncounterClass::name)),
            "side_s" => Number(self.s),
            "dgamma_required" => Number(self.dgamma),
            "dalpha_first_order" => Number(self.by_least_norm().0),
            "dVA_first_order" => Number(self.by_least_norm().1),
            "eq18_dalpha" => Number(self.by_eq18().0),
            "eq18_dVA" => Number(self.by_eq18().1),
            "turn" => Word(strategy::turn_name(self.by_eq18().0)),
            "gamma_after_first_order" => {
                let (d_alpha, d_va) = self.by_eq18();
                let (v_s, v_theta) =
                    equations::los_rates(v_a + d_va, alpha + d_alpha, v_b, beta, theta);
                Angle(equations::gamma(v_s, v_theta))
            }
            "exact_minnorm_VA" => Number(self.exact_least_norm().0),
            "exact_minnorm_alpha" => Angle(self.exact_least_norm().1),
            "exact_heading_only_alpha" => Angle(if self.flag {
                equations::exact_heading_only(v_a, alpha, v_b, beta, self.edge())
                    .unwrap_or(f64::NAN)
            } else {
                alpha
            }),
            "dcpa_signed" => Number(equations::dcpa_signed(d, self.gamma)),
            "tcpa" => Number(equations::tcpa(d, self.v_s, dv)),
            _ => return None,
        })
    }

    fn edge(&self) -> f64 {
        self.theta + self.s * self.mu
    }

    fn by_eq18(&self) -> equations::PolarChange {
        let Self { v_a, alpha, v_b, beta, dgamma, .. } = *self;
        let varphi = equations::varphi(alpha, equations::phi(v_a, alpha, v_b, beta));
        equations::step(v_a, equations::dv(v_a, alpha, v_b, beta), dgamma, varphi)
    }

    fn by_least_norm(&self) -> equations::PolarChange {
        equations::step_by_least_norm(self.v_a, self.alpha, self.v_b, self.beta, self.dgamma)
    }

    fn exact_least_norm(&self) -> (f64, f64) {
        if !self.flag {
            return (self.v_a, self.alpha);
        }
        equations::exact_least_norm(self.v_a, self.alpha, self.v_b, self.beta, self.edge())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OURS: &str = include_str!("../tests/data/vectors.csv");

    #[test]
    fn every_row_passes_in_every_column_that_applies() {
        let report = check_vectors(OURS).unwrap();
        assert_eq!(report.rows, 24);
        assert_eq!(report.columns.len(), 22);
        for column in &report.columns {
            assert_eq!(column.cells, 24, "{column:?}");
            assert!(column.error_max <= LIMIT, "{column:?}");
        }
        assert!(report.passes());
    }

    /// Each column is really compared: any cell of a row that is changed by 1e-6 is found.
    #[test]
    fn a_changed_cell_fails_in_its_column() {
        let row = OURS.lines().position(|line| line.starts_with("cross_stbd_obtuse")).unwrap();
        let columns =
            OURS.lines().find(|line| line.starts_with("name")).unwrap().split(',').count();
        for i in 8..columns {
            let mut lines: Vec<String> = OURS.lines().map(str::to_owned).collect();
            let mut cells: Vec<String> = lines[row].split(',').map(str::to_owned).collect();
            cells[i] = match cells[i].parse::<f64>() {
                Ok(value) => (value + 1e-6).to_string(),
                Err(_) => "nonsense".to_owned(),
            };
            lines[row] = cells.join(",");
            let report = check_vectors(&lines.join("\n")).unwrap();
            assert!(!report.passes());
            let worst = &report.columns[i - 8];
            assert!(worst.error_max > 9e-7 && worst.worst_row == "cross_stbd_obtuse", "{worst:?}");
        }
    }

    #[test]
    fn broken_files_are_refused() {
        let head = "name,V_A,alpha_deg,V_B,beta_deg,theta_deg,D,R";
        assert_eq!(check_vectors("# only a comment"), Err(VectorsError::Empty));
        assert_eq!(check_vectors("name,V_A"), Err(VectorsError::MissingColumn("alpha_deg".into())));
        let unknown = check_vectors(&format!("{head},zeta"));
        assert_eq!(unknown, Err(VectorsError::UnknownColumn("zeta".into())));
        let short = check_vectors(&format!("{head},mu\na,1,2"));
        assert_eq!(short, Err(VectorsError::Cells { line: 2, found: 3, expected: 9 }));
        let text = check_vectors(&format!("{head},mu\na,8,x,6,-90,90,1500,150,0.1"));
        assert!(matches!(text, Err(VectorsError::Number { line: 2, .. })));
    }
}
