//! The report says what its data say, and nothing else.

mod fixture;

use fixture::{card, case, row};
use record::{DistanceKind, EncounterClass, Outcome, Reaction, Seed};
use report::{Case, Compared, Cost, Extra, ReportInput, render, write};
use std::fs;
use summary::{Summary, SummaryHead, Tallies};

fn data(strata: &[&str], n: u64, contact_every: u64) -> (Summary, Tallies) {
    let mut tallies = Tallies::new();
    for stratum in strata {
        (0..n).for_each(|j| tallies.add(&row(stratum, j, contact_every)));
        tallies.stratum_mut(stratum).add_draws(2 * n, n);
    }
    (summary(&tallies, strata, "zhuang"), tallies)
}

fn summary(tallies: &Tallies, strata: &[&str], planner: &str) -> Summary {
    let head = SummaryHead {
        campaign: "quick".into(),
        planner: planner.into(),
        seed: Seed(20_261_121),
        root_digest: "5f".repeat(32),
    };
    Summary::new(head, tallies, strata.iter().copied())
}

fn page(summary: &Summary, tallies: &Tallies, cases: &[Case]) -> String {
    let card = card();
    let input = ReportInput { card: &card, summary, tallies, findings: &[], cases, scenes: &[] };
    let files = render(&input).expect("the templates fit");
    assert_eq!(files[0].path.to_str(), Some("report.html"));
    // The template engine writes a slash as an entity, which is the same to a browser.
    files[0].text.replace("&#x2f;", "/")
}

fn classes() -> Vec<&'static str> {
    EncounterClass::ALL[..5].iter().map(|class| class.name()).collect()
}

#[test]
fn first_screen_follows_the_numbers() {
    let (summary, tallies) = data(&classes(), 400, 100);
    let text = page(&summary, &tallies, &[]);
    assert!(text.contains("20 of 2,000 encounters ended in a collision."));
    let whole = summary::StratumSummary::new("all", &tallies.total());
    assert!(text.contains(&format!("{} of 2,000 encounters", whole.safety_radius.k)));
    assert!(text.contains("<b>1 %</b>"), "20 of 2,000 as a headline");
    // Clopper-Pearson for 20 of 2,000: 0.611945 % to 1.540072 %.
    assert!(text.contains("95 % bounds 0.612 % to 1.54 %"));
    assert!(text.contains("Nothing is said about: Look-out and risk (Rules 5 and 7), Safe speed"));
    assert!(text.contains("Five classes &lt;and&gt; their borders"));
    assert!(text.contains("No encounter was chosen to be shown."));
}

#[test]
fn no_failure_is_no_proof() {
    let mut tallies = Tallies::new();
    for j in 0..300 {
        let mut row = row("head_on", j, 0);
        row.safety_radius_broken = false;
        tallies.add(&row);
    }
    let text = page(&summary(&tallies, &["head_on"], "zhuang"), &tallies, &[]);
    assert!(text.contains("No collision and no broken safety radius in 300 encounters."));
    // 1 - 0.025^(1/300)
    assert!(text.contains("up to 1.22 % of such encounters could end in one"));
}

#[test]
fn unknown_runs_are_said_in_the_first_sentences() {
    let mut tallies = Tallies::new();
    for j in 0..10 {
        let mut row = row("head_on", j, 0);
        row.safety_radius_broken = false;
        if j == 3 {
            row.outcome = Outcome::PlannerHung;
            row.unknown = true;
            row.reaction = Reaction::Unknown;
        }
        tallies.add(&row);
    }
    let text = page(&summary(&tallies, &["head_on"], "zhuang"), &tallies, &[]);
    assert!(text.contains("class=\"verdict warn\""));
    assert!(text.contains("The outcome of 1 encounter is unknown"));
    assert!(text.contains("<th>planner hung</th>"));
}

#[test]
fn nothing_at_all_still_makes_a_page() {
    let tallies = Tallies::new();
    let text = page(&summary(&tallies, &[], "zhuang"), &tallies, &[]);
    assert!(text.contains("No encounter was run."));
    assert!(text.matches("No data for this figure.").count() == 5);
    assert!(!text.contains("NaN") && !text.contains("inf "));
}

/// A folder of files gives a stratum for each: figures draw them together, tables name them all.
#[test]
fn many_strata_are_drawn_together_and_listed_each() {
    let names: Vec<String> = (0..20).map(|i| format!("HO, case {i}")).collect();
    let strata: Vec<&str> = names.iter().map(String::as_str).collect();
    let (summary, tallies) = data(&strata, 3, 0);
    let text = page(&summary, &tallies, &[]);
    assert!(names.iter().all(|name| text.contains(&format!("<td>{name}</td>"))));
    assert!(text.contains("n = 60 in 20 strata"));
    // 20 lines in the rates and one for all; the other figures have the one for all alone.
    assert_eq!(text.matches("\nall strata\n</text>").count(), 3);
}

#[test]
fn page_needs_no_network_and_its_tags_are_balanced() {
    let (summary, tallies) = data(&classes(), 100, 20);
    let cases = [case(7, 25.0, 1, 260, 1700.0)];
    let text = page(&summary, &tallies, &cases);
    for forbidden in ["src=\"http", "href=\"http", "@import", "<script src", "<link", "url(http"] {
        assert!(!text.contains(forbidden), "{forbidden}");
    }
    for tag in ["div", "table", "tr", "td", "figure", "details", "svg", "main", "ul", "p"] {
        let open =
            text.matches(&format!("<{tag}>")).count() + text.matches(&format!("<{tag} ")).count();
        assert_eq!(open, text.matches(&format!("</{tag}>")).count(), "{tag}");
    }
    assert!(text.contains("seatrial replay reports/quick-zhuang crossing_stbd/000007"));
    assert!(text.contains("nothing that the other ship did made it so"));
    assert_eq!(text.matches("@font-face").count(), 2);
    assert!(!text.contains("comparison.html"));
    assert!(text.contains("var(--own)") && !text.contains("\"#1F5FBF\""));
}

#[test]
fn same_input_gives_the_same_bytes_and_other_numbers_others() {
    let card = card();
    let cases = [case(7, 25.0, 0, 260, 1700.0)];
    let (summary, tallies) = data(&["head_on"], 100, 20);
    let input = ReportInput {
        card: &card,
        summary: &summary,
        tallies: &tallies,
        findings: &[],
        cases: &cases,
        scenes: &[],
    };
    let once = render(&input).unwrap();
    assert_eq!(render(&input).unwrap(), once);
    let (summary, tallies) = data(&["head_on"], 101, 20);
    let other = ReportInput { summary: &summary, tallies: &tallies, ..input };
    for (a, b) in once.iter().zip(render(&other).unwrap()) {
        assert_eq!(a.text == b.text, a.path.to_str().unwrap().contains("case"), "{:?}", a.path);
    }
}

/// A collision is at the end of a run; a long run must not make the page heavy.
#[test]
fn long_runs_are_played_from_fewer_samples_to_their_end() {
    let (summary, tallies) = data(&["crossing_stbd"], 50, 20);
    let played = |n: usize| {
        let text = page(&summary, &tallies, &[case(0, 25.0, 3, n, 1700.0)]);
        let data = text.split_once("id=\"p-data\">").unwrap().1.split_once("</script>").unwrap().0;
        assert!(data.len() <= 100_000, "{n} samples take {} bytes", data.len());
        let mut cases: serde_json::Value = serde_json::from_str(data).unwrap();
        cases[0].take()
    };
    let north = |case: &serde_json::Value| -> Vec<i64> {
        let list = case["ships"][0]["north"].as_array().unwrap();
        list.iter().map(|d| d.as_i64().unwrap()).collect()
    };
    let short = played(260);
    assert_eq!((short["sample_s"].as_f64(), north(&short).len()), (Some(1.0), 260));
    let long = played(5000);
    let track = case(0, 25.0, 3, 5000, 1700.0).trace.own;
    assert_eq!(long["last_s"], 4999.0);
    assert!(long["sample_s"].as_f64().unwrap() > 1.0, "{}", long["sample_s"]);
    assert_eq!(north(&long).iter().sum::<i64>(), (10.0 * track.north_m[4999]).round() as i64);
}

/// A picture for each moment that counts, under the scene's own name.
#[test]
fn named_scenes_are_drawn_as_the_paper_draws_them() {
    let card = card();
    let (summary, tallies) = data(&["crossing_stbd"], 50, 20);
    let picture = |others: usize| {
        let scenes = [case(0, 25.0, others, 260, 1700.0)];
        let input = ReportInput {
            card: &card,
            summary: &summary,
            tallies: &tallies,
            findings: &[],
            cases: &[],
            scenes: &scenes,
        };
        let mut files = render(&input).unwrap();
        let scene = files.pop().unwrap();
        assert_eq!(scene.path.to_str(), Some("figures/scene-crossing_stbd.svg"));
        scene.text
    };
    let one = picture(0);
    for text in ["(a) 0 s: original headings", "(b) ", "closest, ", "(c) 259 s: paths"] {
        assert!(one.contains(text), "{text}");
    }
    assert!(!one.contains("(d)"));
    let three = picture(2);
    assert!(three.contains("(d) 259 s: paths") && three.contains("closest to 1, "));
    // start and goal stand in the first panel and in the last
    assert_eq!((one.matches("\nS\n").count(), one.matches("\nG\n").count()), (2, 2));
}

#[test]
fn a_page_beside_others_differs_by_the_link_alone() {
    let (summary, tallies) = data(&["head_on"], 50, 20);
    let text = |beside| {
        let card = report::Card { beside, ..card() };
        let (findings, cases, scenes) = (&[], &[], &[]);
        let input = ReportInput {
            card: &card,
            summary: &summary,
            tallies: &tallies,
            findings,
            cases,
            scenes,
        };
        render(&input).unwrap().swap_remove(0).text
    };
    let beside = text(true);
    assert!(beside.contains("href=\"../comparison.html\""));
    assert_eq!(beside.replacen(report::BESIDE, "", 1), text(false));
}

#[test]
fn writes_the_page_and_a_file_for_each_figure() {
    let folder = tempfile::tempdir().unwrap();
    let card = card();
    let cases = [case(7, 25.0, 0, 260, 1700.0)];
    let (summary, tallies) = data(&["head_on"], 50, 20);
    let input = ReportInput {
        card: &card,
        summary: &summary,
        tallies: &tallies,
        findings: &[],
        cases: &cases,
        scenes: &[],
    };
    let paths = write(folder.path(), &input).unwrap();
    let mut names: Vec<String> = paths
        .iter()
        .map(|path| path.strip_prefix(folder.path()).unwrap().display().to_string())
        .collect();
    names.sort();
    assert_eq!(
        names,
        [
            "figures/bearing_speed.svg",
            "figures/case-crossing_stbd-000007.svg",
            "figures/cpa.svg",
            "figures/polar.svg",
            "figures/rates.svg",
            "figures/reaction.svg",
            "report.html"
        ]
    );
    let files = fs::read_dir(folder.path().join("figures")).unwrap().count();
    assert_eq!(files, 6, "no temporary file is left");
    let alone = folder.path().join("one.svg");
    report::draw_case(&alone, &cases[0]).unwrap();
    let drawn = fs::read_to_string(&alone).unwrap();
    assert_eq!(drawn, fs::read_to_string(folder.path().join(&names[1])).unwrap());
    assert!(drawn.contains(">\nS\n<") && drawn.contains(">\nG\n<"));
}

#[test]
fn unusual_cases_are_drawn() {
    for case in
        [case(1, 25.0, 0, 1, 100.0), case(2, 0.0, 3, 260, 9000.0), case(3, -170.0, 0, 2, 1700.0)]
    {
        let text = report::case_picture(&case);
        assert!(text.trim_end().ends_with("</svg>") && !text.contains("NaN"), "{}", case.row.id);
    }
    let mut centre = case(4, 25.0, 0, 260, 1700.0);
    centre.trace.distance = DistanceKind::Centre;
    assert!(report::case_picture(&centre).contains("between reference points"));
    let mut alone = case(5, 25.0, 0, 50, 1700.0);
    alone.trace.targets.clear();
    alone.trace.pairs.clear();
    assert!(!report::case_picture(&alone).contains("NaN"));
    let empty = case(6, 25.0, 0, 0, 1700.0);
    assert!(report::case_picture(&empty).contains("this run left no track"));
}

#[test]
fn planners_stand_side_by_side_only_over_the_same_encounters() {
    let folder = tempfile::tempdir().unwrap();
    let card = card();
    let (a, tallies_a) = data(&classes(), 200, 50);
    let (_, tallies_b) = data(&classes(), 200, 10);
    let b = summary(&tallies_b, &classes(), "hold-course");
    let column =
        |summary, tallies, link| Compared { card: &card, summary, tallies, link, cost: None };
    let columns = [
        column(&a, &tallies_a, "zhuang/report.html"),
        column(&b, &tallies_b, "hold-course/report.html"),
    ];
    report::write_comparison(folder.path(), &columns).unwrap();
    let text = fs::read_to_string(folder.path().join("comparison.html")).unwrap();
    let text = text.replace("&#x2f;", "/");
    assert!(text.contains("<a href=\"hold-course/report.html\">hold-course</a>"));
    assert!(text.contains("2 % (20 of 1,000)") && text.contains("10 % (100 of 1,000)"));
    assert!(!text.contains("cannot be compared") && !text.contains("extra distance"));
    let extra = |encounters, distance_m| Extra { encounters, distance_m, time_s: 7.25 };
    let cost = Cost {
        planning_us_per_call: 1.375,
        whole: extra(10, 123.0),
        strata: vec![("head_on".to_owned(), extra(5, 321.0))],
    };
    let columns = columns.map(|column| Compared { cost: Some(&cost), ..column });
    report::write_comparison(folder.path(), &columns).unwrap();
    let text = fs::read_to_string(folder.path().join("comparison.html")).unwrap();
    let of = |number: &str| text.matches(&format!("<td>{number}</td>")).count();
    // both planners; all strata together, then the one that was looked at
    assert_eq!([of("123"), of("321"), of("7.2"), of("1.38")], [2, 2, 4, 2], "{text}");
    // rates of each stratum with their bounds stand in tables of their own
    for name in classes() {
        assert!(text.contains(&format!("<h2>{name}</h2>")), "{name}");
    }
    let (c, tallies_c) = data(&classes(), 199, 10);
    let columns = [columns[0], column(&c, &tallies_c, "c/report.html")];
    report::write_comparison(folder.path(), &columns).unwrap();
    let text = fs::read_to_string(folder.path().join("comparison.html")).unwrap();
    assert!(text.contains("cannot be compared"));
}
