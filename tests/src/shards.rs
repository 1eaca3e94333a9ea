//! A campaign on several machines ends as on one.

use crate::support::{files, json, run_err, run_ok};
use std::fs;
use std::path::Path;

const CAMPAIGN: &str = "campaign laboratory --encounters 510 --planner hold-course --quiet";

const SMALL: &str = "campaign quick --encounters 3 --planner hold-course --quiet";
const JUDGE: &str = "judge result --rules usv-ccta2023-v1 --quiet";

fn run_shards(folder: &Path, campaign: &str, of: u64, which: impl Iterator<Item = u64>) {
    for i in which {
        run_ok(folder, &format!("{campaign} --shard {i}/{of} --out result/shard-{i:04}"));
    }
}

/// The folder has the same name everywhere: a report names it in its replay command. Of 100 shards
/// most are empty.
#[test]
fn any_number_of_shards_merges_to_the_bytes_of_one_machine() {
    for (campaign, shards) in [(CAMPAIGN, &[7][..]), (SMALL, &[1, 7, 100][..])] {
        let one = tempfile::tempdir().unwrap();
        run_ok(one.path(), &format!("{campaign} --out result"));
        for &of in shards {
            let many = tempfile::tempdir().unwrap();
            run_shards(many.path(), campaign, of, 1..=of);
            run_ok(many.path(), "missing result");
            run_ok(many.path(), "merge result --quiet");
            for file in ["runs.parquet", "summary.json", "report.html", "manifest.json"] {
                let read = |folder: &Path| fs::read(folder.join("result").join(file)).unwrap();
                assert!(read(one.path()) == read(many.path()), "{of} shards: {file} differs");
            }
        }
    }
}

/// Numbers, report and identity are those of one machine; only the rows lie elsewhere.
#[test]
fn the_rows_of_a_merge_can_stay_in_its_parts() {
    let one = tempfile::tempdir().unwrap();
    run_ok(one.path(), &format!("{SMALL} --out result"));
    run_ok(one.path(), JUDGE);
    let of_one = one.path().join("result");
    for of in [1, 7] {
        let many = tempfile::tempdir().unwrap();
        run_shards(many.path(), SMALL, of, 1..=of);
        run_ok(many.path(), "merge result --table-in-parts --quiet");
        let result = many.path().join("result");
        assert!(!result.join("runs.parquet").exists());
        let figures = files(&of_one.join("figures")).into_iter();
        let figures = figures.map(|figure| Path::new("figures").join(figure));
        for file in ["summary.json", "report.html"].into_iter().map(Into::into).chain(figures) {
            let same =
                fs::read(of_one.join(&file)).unwrap() == fs::read(result.join(&file)).unwrap();
            assert!(same, "{of} shards: {} differs", file.display());
        }
        let manifest = json(result.join("manifest.json"));
        assert_eq!(manifest["root_digest"], json(of_one.join("manifest.json"))["root_digest"]);
        assert!(manifest["files_sha256"]["parts.b3"].is_string(), "{manifest}");
        // `b3sum --check parts.b3`
        let list = fs::read_to_string(result.join("parts.b3")).unwrap();
        for line in list.lines() {
            let (hash, path) = line.split_once("  ").unwrap();
            let part = fs::read(result.join(path)).unwrap();
            assert_eq!(hash, blake3::hash(&part).to_hex().as_str(), "{path}");
        }
        assert_eq!(list.lines().count(), 9);

        let said = run_ok(many.path(), "replay result crossing_stbd/000002");
        assert!(said.contains("the same bits as stored"), "{said}");
        run_ok(many.path(), JUDGE);
        for file in ["runs.parquet", "summary.json"] {
            let read =
                |dir: &Path| fs::read(dir.join("judged-usv-ccta2023-v1").join(file)).unwrap();
            assert!(read(&of_one) == read(&result), "{of} shards: judged {file} differs");
        }
        let said = run_err(many.path(), "evidence result --out pack", 2);
        assert!(said.contains("parts.b3") && said.contains("merge result"), "{said}");
        let said = run_err(many.path(), "merge result --table-in-parts", 2);
        assert!(said.contains("finished already"), "{said}");
        // the table after all
        run_ok(many.path(), "merge result --quiet");
        assert!(!result.join("parts.b3").exists());
        for file in ["runs.parquet", "summary.json", "report.html", "manifest.json"] {
            let same = fs::read(of_one.join(file)).unwrap() == fs::read(result.join(file)).unwrap();
            assert!(same, "{of} shards: {file} differs after the second merge");
        }
    }
}

#[test]
fn parts_that_are_the_table_cannot_be_changed_or_lie_elsewhere() {
    let folder = tempfile::tempdir().unwrap();
    run_shards(folder.path(), SMALL, 2, 1..=2);
    fs::rename(folder.path().join("result/shard-0002"), folder.path().join("away")).unwrap();
    let said = run_err(folder.path(), "merge result away --table-in-parts", 2);
    assert!(said.contains("away") && said.contains("move"), "{said}");
    fs::rename(folder.path().join("away"), folder.path().join("result/shard-0002")).unwrap();
    run_ok(folder.path(), "merge result --table-in-parts --quiet");
    let list = folder.path().join("result/parts.b3");
    let lines = fs::read_to_string(&list).unwrap();
    let part = lines.lines().nth(4).unwrap().split_once("  ").unwrap().1;
    let path = folder.path().join("result").join(part);
    let whole = fs::read(&path).unwrap();
    let mut changed = whole.clone();
    *changed.last_mut().unwrap() ^= 1;
    fs::write(&path, changed).unwrap();
    let said = run_err(folder.path(), JUDGE, 2);
    assert!(said.contains(part) && said.contains("changed"), "{said}");
    fs::write(&path, whole).unwrap();
    // whole and of this campaign, but not the file that was merged
    fs::write(&list, lines.replacen(&lines[..4], "0000", 1)).unwrap();
    let said = run_err(folder.path(), JUDGE, 2);
    assert!(said.contains("is not the file that"), "{said}");
    let last = lines.lines().last().unwrap();
    fs::write(&list, lines.replace(&format!("{last}\n"), "")).unwrap();
    let said = run_err(folder.path(), JUDGE, 2);
    assert!(said.contains("0008-00000000.part is not in its place"), "{said}");
}

#[test]
fn gaps_are_named_and_refused() {
    let folder = tempfile::tempdir().unwrap();
    run_shards(folder.path(), SMALL, 6, (1..=6).filter(|i| *i != 2 && *i != 3));
    let said = run_err(folder.path(), "missing result --of 6", 3);
    assert!(said.contains("4 of 9"), "{said}");
    let said = run_err(folder.path(), "merge result --quiet", 3);
    assert!(said.contains("crossing_stbd/000000"), "{said}");
    assert!(!folder.path().join("result/manifest.json").exists());
    run_shards(folder.path(), SMALL, 6, 2..=3);
    run_ok(folder.path(), "merge result --quiet");
}

#[test]
fn duplicates_and_parts_of_another_campaign_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    run_shards(folder.path(), SMALL, 2, 1..=2);
    let parts = |i: u64| folder.path().join(format!("result/shard-{i:04}/state/parts"));
    let name = "0000-00000000.part";
    fs::copy(parts(1).join(name), parts(2).join(name)).unwrap();
    let said = run_err(folder.path(), "merge result --quiet", 2);
    assert!(said.contains(name) && said.contains("shard-0002"), "{said}");
    fs::remove_file(parts(2).join(name)).unwrap();
    run_ok(folder.path(), &format!("{SMALL} --seed 2 --shard 2/2 --out other"));
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
