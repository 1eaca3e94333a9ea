#!/usr/bin/env python3
"""A campaign on a Dask cluster: one task for each shard, then the merge on this machine.

    python3 dask_campaign.py tcp://scheduler:8786 200 /shared/quick quick --planner zhuang

Needs `dask.distributed` and the binary `seatrial` on every worker, and a folder that all share.
The arguments after the folder are those of `seatrial campaign`. Parts that are whole are not run
again, so a second call takes up where the first one stopped.
"""
import subprocess
import sys

# wrong input and a harness fault would come again
FINAL = {2, 4}
RETRIES = 3


def run_shard(index, of, folder, campaign):
    """Runs one shard; raises so that Dask tries it again."""
    out = f"{folder}/shard-{index:04d}"
    command = ["seatrial", "campaign", *campaign, "--shard", f"{index}/{of}"]
    command += ["--threads", "1", "--out", out, "--resume", "--quiet"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode == 0 or done.returncode in FINAL:
        return index, done.returncode, done.stderr
    raise RuntimeError(f"shard {index} ended with {done.returncode}: {done.stderr}")


def main():
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    scheduler, shards, folder, *campaign = sys.argv[1:]
    from dask.distributed import Client, as_completed

    of = int(shards)
    with Client(scheduler) as client:
        tasks = [
            client.submit(run_shard, i, of, folder, campaign, retries=RETRIES, pure=False)
            for i in range(1, of + 1)
        ]
        for task in as_completed(tasks):
            index, code, said = task.result()
            if code != 0:
                sys.exit(f"shard {index} ended with {code}: {said}")
    sys.exit(subprocess.run(["seatrial", "merge", folder]).returncode)


if __name__ == "__main__":
    main()
