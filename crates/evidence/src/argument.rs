//! The argument of a pack in the goal structuring notation, drawn as a tree.
//!
//! Goal: rectangle; strategy: parallelogram; context: rounded box; assumption: ellipse; solution:
//! circle. A goal is stated with the numbers found, never as reached: whether they are good enough
//! is the assessor's to say. Every leaf names a file of the pack and the start of its SHA-256.

use crate::claims::{Claim, HAZARDS};
use crate::pack::PackInput;
use crate::sections::{READINGS, SELF_TEST, Sections};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;

/// A node of the argument.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Node {
    pub(crate) id: String,
    /// `goal`, `strategy`, `context`, `assumption` or `solution`.
    pub(crate) kind: &'static str,
    pub(crate) text: String,
    /// The node that it supports, or explains.
    pub(crate) parent: Option<String>,
    /// The file that carries a solution, with its SHA-256.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) file: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) sha256: Option<String>,
}

/// The nodes; `hashes` are those of the files that leaves point at.
pub(crate) fn nodes(
    input: &PackInput<'_>,
    sections: &Sections,
    hashes: &BTreeMap<String, String>,
) -> Vec<Node> {
    let claims = input.gathered.claims.list();
    let mut tree = Tree { nodes: top(input, sections), hashes };
    for (i, hazard) in HAZARDS.iter().enumerate() {
        let id = format!("G{}", i + 1);
        tree.goal(&id, format!("{} is avoided: {}", hazard.id, hazard.text));
        for claim in claims.iter().filter(|claim| claim.hazard == *hazard) {
            tree.leaf(&claim.id, said(claim), &id, &claim.file());
        }
    }
    let plan = format!("G{}", HAZARDS.len() + 1);
    tree.goal(&plan, "The numbers are those of the plan".to_owned());
    for (name, text, file) in [
        ("plan", "the plan, fixed before the run", "plan/plan.json"),
        ("rows", "one row for every encounter", "result/runs.parquet"),
        ("summary", "every rate with its bounds", "result/summary.json"),
        ("report", "figures and findings", "result/report.html"),
    ] {
        tree.leaf(name, text.to_owned(), &plan, file);
    }
    for file in sections.planner_files.iter().flat_map(|planner| &planner.files) {
        tree.leaf(&file.path, "the planner itself".to_owned(), &plan, &file.path);
    }
    let bench = format!("G{}", HAZARDS.len() + 2);
    tree.goal(&bench, "The bench would have seen it".to_owned());
    if let Some(test) = &sections.self_test {
        let text = format!("{} of {} bad planners caught", test.killed, test.killings.len());
        tree.leaf("self-test", text, &bench, SELF_TEST);
    }
    if !sections.readings.is_empty() {
        tree.leaf("readings", "how each check reads its rule".to_owned(), &bench, READINGS);
    }
    for document in &sections.documents {
        tree.leaf(&document.path, document.title.clone(), &bench, &document.path);
    }
    tree.nodes
}

fn said(claim: &Claim) -> String {
    if claim.n == 0 {
        format!("{}: untested", claim.requirement)
    } else {
        format!("{}: broken in {} of {}", claim.requirement, claim.broken, claim.n)
    }
}

/// What stands above the goals.
fn top(input: &PackInput<'_>, sections: &Sections) -> Vec<Node> {
    let plan = input.plan;
    let g0 = format!("Planner {} avoids the hazards of collision avoidance", plan.planner.name);
    let campaign = format!("campaign {}: {}", plan.campaign, plan.title);
    let assumptions =
        format!("assumptions A1 to A{} of section 20 hold", sections.assumptions.len());
    let strategy = "over hazards, by counting encounters".to_owned();
    vec![
        node("G0", "goal", g0, None),
        node("C1", "context", campaign, Some("G0")),
        node("C2", "context", format!("rule set {}", plan.rules.name), Some("G0")),
        node("A", "assumption", assumptions, Some("G0")),
        node("S1", "strategy", strategy, Some("G0")),
    ]
}

fn node(id: &str, kind: &'static str, text: String, parent: Option<&str>) -> Node {
    let parent = parent.map(str::to_owned);
    Node { id: id.to_owned(), kind, text, parent, file: None, sha256: None }
}

struct Tree<'a> {
    nodes: Vec<Node>,
    hashes: &'a BTreeMap<String, String>,
}

impl Tree<'_> {
    fn goal(&mut self, id: &str, text: String) {
        self.nodes.push(node(id, "goal", text, Some("S1")));
    }

    fn leaf(&mut self, name: &str, text: String, parent: &str, file: &str) {
        self.nodes.push(Node {
            file: Some(file.to_owned()),
            sha256: self.hashes.get(file).cloned(),
            ..node(&format!("Sn-{name}"), "solution", text, Some(parent))
        });
    }
}

const COLUMN: f64 = 196.0;
const BOX: f64 = 180.0;
const LEAF_TOP: f64 = 296.0;
const LEAF_STEP: f64 = 74.0;
const LEAF_LETTERS: usize = 24;
/// A goal with more leaves than this has them in several columns, so that the tree fits a page.
const LEAVES_MAX: usize = 8;

/// The tree as a whole SVG document.
pub(crate) fn svg(nodes: &[Node]) -> String {
    let goals: Vec<&Node> = nodes.iter().filter(|n| n.parent.as_deref() == Some("S1")).collect();
    let leaves = |goal: &Node| -> Vec<&Node> {
        nodes.iter().filter(|n| n.parent.as_deref() == Some(goal.id.as_str())).collect()
    };
    let columns = |goal: &Node| leaves(goal).len().div_ceil(LEAVES_MAX).max(1);
    let deepest = goals.iter().map(|goal| leaves(goal).len().min(LEAVES_MAX)).max().unwrap_or(0);
    let width = COLUMN * goals.iter().map(|goal| columns(goal)).sum::<usize>() as f64 + 20.0;
    let height = LEAF_TOP + LEAF_STEP * deepest as f64 + 10.0;
    let middle = width / 2.0;
    let mut art = Art::default();
    art.line(middle, 74.0, middle, 112.0);
    let context: Vec<&Node> =
        nodes.iter().filter(|n| matches!(n.kind, "context" | "assumption")).collect();
    for (i, node) in context.iter().enumerate() {
        let (x, y) =
            [(middle - 330.0, 46.0), (middle + 330.0, 46.0), (middle + 330.0, 134.0)][i.min(2)];
        art.line(middle, if y < 100.0 { 46.0 } else { 60.0 }, x, y);
        art.node(node, x, y);
    }
    if let Some(top) = nodes.iter().find(|n| n.id == "G0") {
        art.node(top, middle, 46.0);
    }
    let mut x = 10.0 + COLUMN * 0.5;
    for goal in goals {
        art.line(middle, 154.0, x, 214.0);
        art.node(goal, x, 240.0);
        for (i, below) in leaves(goal).chunks(LEAVES_MAX).enumerate() {
            let x = x + COLUMN * i as f64;
            // further columns hang on a line from the first one's stem
            let top = if i == 0 { 260.0 } else { LEAF_TOP - 14.0 };
            art.line(x - 84.0 - if i == 0 { 0.0 } else { COLUMN }, top, x - 84.0, top);
            art.line(x - 84.0, top, x - 84.0, LEAF_TOP + LEAF_STEP * (below.len() as f64 - 0.6));
            for (k, leaf) in below.iter().enumerate() {
                let y = LEAF_TOP + LEAF_STEP * (k as f64 + 0.4);
                art.line(x - 84.0, y, x - 60.0, y);
                art.node(leaf, x, y);
            }
        }
        x += COLUMN * columns(goal) as f64;
    }
    if let Some(strategy) = nodes.iter().find(|n| n.id == "S1") {
        art.node(strategy, middle, 134.0);
    }
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
         viewBox=\"0 0 {width:.0} {height:.0}\" role=\"img\" aria-label=\"argument\" \
         font-family=\"Helvetica,Arial,sans-serif\" font-size=\"11\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{}{}</svg>\n",
        art.lines, art.shapes
    )
}

#[derive(Default)]
struct Art {
    lines: String,
    shapes: String,
}

impl Art {
    fn line(&mut self, x1: f64, y1: f64, x2: f64, y2: f64) {
        writeln!(
            self.lines,
            "<path d=\"M{x1:.1} {y1:.1}L{x2:.1} {y2:.1}\" stroke=\"#57606a\" fill=\"none\"/>"
        )
        .expect("a String takes every write");
    }

    fn node(&mut self, node: &Node, x: f64, y: f64) {
        let (half, style) = (BOX / 2.0, "fill=\"#f4f6f8\" stroke=\"#1b1f24\"");
        let (left, right) = (x - half, x + half);
        let shape = match node.kind {
            "strategy" => format!(
                "<path d=\"M{:.1} {:.1}H{right:.1}L{:.1} {:.1}H{left:.1}Z\" {style}/>",
                left + 14.0,
                y - 22.0,
                right - 14.0,
                y + 22.0
            ),
            "assumption" => {
                format!("<ellipse cx=\"{x:.1}\" cy=\"{y:.1}\" rx=\"{half}\" ry=\"30\" {style}/>")
            }
            "solution" => format!(
                "<circle cx=\"{:.1}\" cy=\"{y:.1}\" r=\"9\" fill=\"#e8f0f7\" stroke=\"#1b1f24\"/>",
                x - 60.0
            ),
            kind => {
                let round = if kind == "context" { 16 } else { 0 };
                format!(
                    "<rect x=\"{left:.1}\" y=\"{:.1}\" width=\"{BOX}\" height=\"56\" \
                     rx=\"{round}\" {style}/>",
                    y - 28.0
                )
            }
        };
        self.shapes.push_str(&shape);
        if node.kind == "solution" {
            self.words(&node.text, (x - 46.0, y - 14.0), LEAF_LETTERS, "start");
            let hash = node.sha256.as_deref().map_or("", |hash| &hash[..12]);
            let file = node.file.as_deref().unwrap_or("");
            let label = format!("{file} {hash}");
            let lines = wrapped(&node.text, LEAF_LETTERS).len() as f64;
            self.small(&label, x - 46.0, y - 14.0 + 12.0 * lines);
        } else {
            let text = format!("{}: {}", node.id, node.text);
            let letters = if node.kind == "strategy" { 23 } else { 29 };
            let lines = wrapped(&text, letters).len() as f64;
            self.words(&text, (x, y + 4.0 - 6.0 * (lines - 1.0)), letters, "middle");
        }
    }

    fn words(&mut self, text: &str, (x, y): (f64, f64), letters: usize, anchor: &str) {
        for (i, line) in wrapped(text, letters).iter().enumerate() {
            writeln!(
                self.shapes,
                "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\" \
                 fill=\"#1b1f24\">{}</text>",
                y + 12.0 * i as f64,
                escape(line)
            )
            .expect("a String takes every write");
        }
    }

    fn small(&mut self, text: &str, x: f64, y: f64) {
        for (i, line) in text.split(' ').enumerate() {
            writeln!(
                self.shapes,
                "<text x=\"{x:.1}\" y=\"{:.1}\" font-size=\"9\" fill=\"#57606a\">{}</text>",
                y + 10.0 * i as f64,
                escape(line)
            )
            .expect("a String takes every write");
        }
    }
}

/// Lines of about so many letters, broken at spaces.
fn wrapped(text: &str, letters: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let last = lines.last_mut().expect("there is always a line");
        if last.is_empty() {
            last.push_str(word);
        } else if last.chars().count() + 1 + word.chars().count() <= letters {
            last.push(' ');
            last.push_str(word);
        } else {
            lines.push(word.to_owned());
        }
    }
    lines
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
