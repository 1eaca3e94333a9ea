//! `verify`: a pack against itself, against what is made again from its rows, and against the
//! encounters run again.

use super::evidence::{failed, make};
use super::verify_again::run_again;
use super::verify_planner::Known;
use crate::build;
use crate::exit::Ended;
use crate::say::say;
use campaign::{Error, Plan};
use evidence::{
    Files, Gathered, Manifest, Problem, RESULT, SIGNATURE, STATEMENT, SignatureState, VOLATILE,
};
use planner_api::Registry;
use std::path::Path;

/// What was asked for.
#[derive(Debug)]
pub(super) struct Wanted<'a> {
    pub(super) pack: &'a Path,
    /// The line of a minisign public key.
    pub(super) key: Option<&'a str>,
    /// Encounters run again besides the failures.
    pub(super) sample: u64,
    /// Seed of the sample; fresh entropy without one.
    pub(super) seed: Option<u64>,
    /// Whether a planner from outside that is in the pack may be started.
    pub(super) planner: bool,
}

pub(super) fn run(wanted: &Wanted<'_>, registry: Registry) -> Result<Ended, Error> {
    let pack = evidence::read_all(wanted.pack).map_err(failed)?;
    let (mut problems, manifest) = evidence::inspect(&pack);
    say!("files: {} read, {} problems", pack.len(), problems.len());
    let signature = evidence::check_signature(
        pack.get(STATEMENT).map_or(&[], Vec::as_slice),
        pack.get(SIGNATURE).map(Vec::as_slice),
        wanted.key,
    );
    match signature {
        SignatureState::Good => say!("signature: good"),
        SignatureState::Unsigned => {
            say!("signature: none; who can write the folder could have made all of it anew")
        }
        SignatureState::NotChecked => {
            say!("signature: there, not checked; give the public key with --key");
        }
        SignatureState::Bad(why) => {
            problems.push(Problem { path: SIGNATURE.to_owned(), what: why });
        }
    }
    if let (true, Some(manifest)) = (problems.is_empty(), manifest) {
        problems = content(wanted, &pack, &manifest, registry)?;
    } else {
        say!("not made again, not run again: the files are not whole");
    }
    for problem in &problems {
        say!("  {problem}");
    }
    say!("verify: {}", if problems.is_empty() { "ok" } else { "FAILED" });
    Ok(if problems.is_empty() { Ended::Done } else { Ended::Failed })
}

/// Makes everything again from the rows, and runs encounters again.
fn content(
    wanted: &Wanted<'_>,
    pack: &Files,
    manifest: &Manifest,
    registry: Registry,
) -> Result<Vec<Problem>, Error> {
    let plan = pack.get("plan/plan.json").map_or(&[][..], Vec::as_slice);
    let plan: Plan = serde_json::from_slice(plan)
        .map_err(|e| Error::input(format!("plan/plan.json was made by another version: {e}")))?;
    let mut problems = Vec::new();
    let table = wanted.pack.join(RESULT).join("runs.parquet");
    let gathered = Gathered::read(&table, &plan).map_err(failed)?;
    let mut differs = |path: &str, what: &str| {
        problems.push(Problem { path: path.to_owned(), what: what.to_owned() });
    };
    if plan.hash()? != manifest.plan_hash {
        differs("plan/plan.json", "is not the plan whose hash the manifest has");
    }
    if gathered.root_digest != manifest.root_digest {
        differs("result/runs.parquet", "its rows do not have the root digest of the manifest");
    }
    if manifest.build.engine != build::build().engine
        || manifest.build.planners != build::build().planners
    {
        say!(
            "note: the pack was made by engine {} and planners {}; this tool has others, so \
             digests may differ for that reason alone",
            &manifest.build.engine[..12],
            &manifest.build.planners[..12]
        );
    }
    let content = Content { pack, manifest, plan: &plan, table: &table };
    match super::verify_planner::registry(&plan, pack, wanted.planner, registry)? {
        Known::Runnable(registry, _files) => {
            problems.extend(content.rendered(&registry)?);
            problems.extend(run_again(wanted, &plan, &registry, &table, &gathered)?);
        }
        Known::RecordAlone(why) => {
            problems.extend(content.without_planner(&gathered)?);
            say!(
                "not run again: {why}. These rest on the record alone: every outcome, distance \
                 and verdict of result/runs.parquet, the tracks in the report, its figures and \
                 exports/, and with them the claims of section 4"
            );
        }
    }
    Ok(problems)
}

/// A pack whose files are whole.
struct Content<'a> {
    pack: &'a Files,
    manifest: &'a Manifest,
    plan: &'a Plan,
    table: &'a Path,
}

impl Content<'_> {
    /// Whether this tool renders as the one that made the pack did.
    fn same_renderer(&self) -> bool {
        let renderer = &self.manifest.renderer;
        if renderer == build::RENDERER {
            return true;
        }
        say!(
            "not rendered again: the pack was rendered by sources {}, this tool has {}; verify \
             with the build of the manifest",
            &renderer[..12.min(renderer.len())],
            &build::RENDERER[..12]
        );
        false
    }

    /// Everything is made again, encounters that are shown are run again.
    fn rendered(&self, registry: &Registry) -> Result<Vec<Problem>, Error> {
        if !self.same_renderer() {
            return Ok(Vec::new());
        }
        let given = super::evidence_given::of_pack(self.pack);
        let again = make(self.plan, registry, self.table, &given)?;
        let problems = evidence::compare(self.pack, &again);
        say!("made again from the rows: {} files, {} differ", again.len(), problems.len());
        let extra = self.pack.keys();
        let extra = extra.filter(|p| !again.contains_key(*p) && !VOLATILE.contains(&p.as_str()));
        let extra = extra.map(|path| Problem {
            path: path.clone(),
            what: "does not belong to a pack of these rows".to_owned(),
        });
        Ok(problems.into_iter().chain(extra).collect())
    }

    /// What follows from the rows is made again; nothing is run.
    fn without_planner(&self, gathered: &Gathered) -> Result<Vec<Problem>, Error> {
        let summary = crate::rendering::summary(
            self.plan,
            &gathered.tallies,
            gathered.root_digest.clone(),
            &gathered.disagreements,
        )?;
        let again = evidence::from_rows(self.plan, gathered, &summary, build::CARGO_LOCK);
        let again = again.map_err(failed)?;
        let mut problems = evidence::compare(self.pack, &again);
        if self.other_libraries() {
            problems.retain(|problem| problem.path != "sbom.cdx.json");
        }
        say!(
            "made again from the rows: {} files, {} differ; the report is not, since its tracks \
             need the planner",
            again.len(),
            problems.len()
        );
        Ok(problems)
    }

    /// The list of libraries is that of the tool that made the pack.
    fn other_libraries(&self) -> bool {
        self.manifest.build.cargo_lock_sha256 != build::build().cargo_lock_sha256
    }
}
