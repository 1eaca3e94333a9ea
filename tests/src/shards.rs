//! A campaign on several machines ends as on one.

use crate::support::{run_err, run_ok};
use std::fs;
use std::path::Path;

const CAMPAIGN: &str = "campaign laboratory --encounters 510 --planner hold-course --quiet";

fn run_shards(folder: &Path, of: u64, which: impl Iterator<Item = u64>) {
    for i in which {
        run_ok(folder, &format!("{CAMPAIGN} --shard {i}/{of} --out result/shard-{i:04}"));
    }
}

/// The folder has the same name everywhere: a report names it in its replay command. Of 100 shards
/// most are empty.
#[test]
fn any_number_of_shards_merges_to_the_bytes_of_one_machine() {
    const SMALL: &str = "campaign quick --encounters 3 --planner hold-course --quiet";
    for (campaign, shards) in [(CAMPAIGN, &[7][..]), (SMALL, &[1, 7, 100][..])] {
        let one = tempfile::tempdir().unwrap();
        run_ok(one.path(), &format!("{campaign} --out result"));
        for &of in shards {
            let many = tempfile::tempdir().unwrap();
            for i in 1..=of {
                let out = format!("--out result/shard-{i:04}");
                run_ok(many.path(), &format!("{campaign} --shard {i}/{of} {out}"));
            }
            run_ok(many.path(), "missing result");
            run_ok(many.path(), "merge result --quiet");
            for file in ["runs.parquet", "summary.json", "report.html", "manifest.json"] {
                let read = |folder: &Path| fs::read(folder.join("result").join(file)).unwrap();
                assert!(read(one.path()) == read(many.path()), "{of} shards: {file} differs");
            }
        }
    }
}

#[test]
fn gaps_are_named_and_refused() {
    let folder = tempfile::tempdir().unwrap();
    run_shards(folder.path(), 6, (1..=6).filter(|i| *i != 2 && *i != 3));
    let said = run_err(folder.path(), "missing result --of 6", 3);
    assert!(said.contains("6 of 18"), "{said}");
    let said = run_err(folder.path(), "merge result --quiet", 3);
    assert!(said.contains("head_on/000500"), "{said}");
    assert!(!folder.path().join("result/manifest.json").exists());
    run_shards(folder.path(), 6, 2..=3);
    run_ok(folder.path(), "merge result --quiet");
}

#[test]
fn duplicates_and_parts_of_another_campaign_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    run_shards(folder.path(), 2, 1..=2);
    let parts = |i: u64| folder.path().join(format!("result/shard-{i:04}/state/parts"));
    let name = "0000-00000000.part";
    fs::copy(parts(1).join(name), parts(2).join(name)).unwrap();
    let said = run_err(folder.path(), "merge result --quiet", 2);
    assert!(said.contains(name) && said.contains("shard-0002"), "{said}");
    fs::remove_file(parts(2).join(name)).unwrap();
    run_ok(folder.path(), &format!("{CAMPAIGN} --seed 2 --shard 2/2 --out other"));
    let said = run_err(folder.path(), "merge result other --quiet", 2);
    assert!(said.contains("different campaigns") && said.contains("seed"), "{said}");
    // a part of the other campaign under the name of one of ours
    let other = folder.path().join("other/state/parts");
    let stranger = fs::read_dir(&other).unwrap().flatten().map(|e| e.file_name()).min().unwrap();
    fs::copy(other.join(&stranger), parts(2).join(&stranger)).unwrap();
    let said = run_err(folder.path(), "merge result --quiet", 2);
    assert!(said.contains("belongs to another campaign"), "{said}");
}

#[test]
fn the_job_array_of_a_cluster_is_within_its_limits_and_names_what_it_runs() {
    let folder = tempfile::tempdir().unwrap();
    run_ok(folder.path(), "slurm quick --shards 200 --out job --encounters 10");
    let array = fs::read_to_string(folder.path().join("job/shard-array.sbatch")).unwrap();
    for words in ["#SBATCH --array=1-200", "#SBATCH --requeue", "--planner zhuang", "/200\""] {
        assert!(array.contains(words), "no {words} in: {array}");
    }
    for script in ["shard-array.sbatch", "shard-merge.sbatch", "shard-submit.sh"] {
        let checked = std::process::Command::new("bash")
            .arg("-n")
            .arg(folder.path().join("job").join(script))
            .status()
            .unwrap();
        assert!(checked.success(), "{script} is no shell script");
    }
    let said = run_err(folder.path(), "slurm quick --shards 1001 --out job", 2);
    assert!(said.contains("1000"), "{said}");
}
