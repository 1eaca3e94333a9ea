//! `corpus`: every case must get the verdict that its file holds.

use super::gate_arms;
use crate::cli_gate::CorpusArgs;
use crate::embedded;
use crate::exit::Ended;
use crate::say::say;
use campaign::Error;
use gate::corpus::{self, Case};
use gate::spec::PlannerSpec;
use gate::{Child, GateSpec};
use planner_api::{Options, Registry};

/// The campaign that lends its plan to the processes that answer; a case brings its own world.
const LENDER: &str = "gate";

pub(super) fn run(args: &CorpusArgs, registry: Registry) -> Result<Ended, Error> {
    let mut cases = corpus::read(&args.dir)?;
    if cases.is_empty() {
        return Err(Error::input(format!("{} holds no case", args.dir.display())));
    }
    let mut wanted: Vec<String> = cases.iter().map(|case| case.found.planner.clone()).collect();
    wanted.extend(args.planners.iter().cloned());
    wanted.sort();
    wanted.dedup();
    let registry = super::with_outside(registry, &wanted)?;
    let asker =
        Asker { spec: GateSpec::parse(&embedded::campaign_text(LENDER)?, LENDER)?, registry };
    let mut moved = 0;
    for case in &mut cases {
        say!("{}", gate::text::case_line(case));
        let now = asker.does(case, &case.found.planner, &case.found.options)?;
        let changes = corpus::changes(&case.found.events, &now);
        for change in &changes {
            say!("  {change}");
        }
        moved += usize::from(!changes.is_empty());
        if args.refresh && !changes.is_empty() {
            case.found.events = now;
            let text = case.text()?;
            // what no longer fails is no case: it is refused as it would be when read
            Case::parse(&text, &case.name)?;
            let path = args.dir.join(format!("{}.toml", case.name));
            crate::files::write(&path, text.as_bytes())?;
        }
        for planner in &args.planners {
            let does = asker.does(case, planner, &Options::new())?;
            let broken = case.must_not.iter().any(|event| does.contains(event));
            say!("  {planner} {}", if broken { "BREAKS it" } else { "passes" });
        }
    }
    say!("{} cases, {moved} with another verdict than their file", cases.len());
    match (moved, args.refresh) {
        (0, _) => Ok(Ended::Done),
        (_, true) => {
            say!("the files hold the new verdicts; CHANGELOG.md says why they had to move");
            Ok(Ended::Done)
        }
        (_, false) => {
            say!("`cargo xtask corpus --refresh` takes them over");
            Ok(Ended::Failed)
        }
    }
}

struct Asker {
    spec: GateSpec,
    registry: Registry,
}

impl Asker {
    /// Everything that a planner does wrong in a case, found in a process of its own.
    fn does(
        &self,
        case: &Case,
        planner: &str,
        options: &Options,
    ) -> Result<Vec<gate::Event>, Error> {
        let asked = PlannerSpec { name: planner.to_owned(), options: options.clone() };
        let find: campaign::spec::FindRules<'_> = &embedded::rules_text;
        let plan = self.spec.plan(&asked, 0, &self.registry, find, &crate::build::build())?;
        let mut arm = Child::start(gate_arms::launch(1)?, plan)?;
        let question = case.question(find, corpus::every_event(), false)?;
        corpus::found(&question, &mut |question| arm.case(question))
    }
}
