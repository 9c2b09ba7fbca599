"""Work that Slurm shares: a cluster of one node, set up here, if it can be."""
import csv
import io
import os
import shutil
import socket
import subprocess
import tempfile
import time
import unittest

from lib.program import PROGRAM, SOURCE, Case, main
from parts import AIR

FARM = os.path.join(SOURCE, "scripts/farm")
NEEDED = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "scancel")
PATH = os.environ["PATH"] + ":/usr/sbin:/sbin"
SIZE = ["--size", "320x180"]
# The program; its second part is held in the middle of its work, the first time.
STOPPED = """#!/bin/sh
[ "$SLURM_ARRAY_TASK_ID" = 2 ] && [ ! -e parts/stopped ] || exec "$REAL" "$@"
"$REAL" "$@" &
until [ -e parts/18.png ]; do sleep 0.005; done
kill -STOP $!
touch parts/stopped
wait $!
"""
CONF = """
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
AuthType=auth/munge
AuthInfo=socket={top}/munge
SlurmUser=root
SlurmdUser=root
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
StateSaveLocation={top}/state
SlurmdSpoolDir={top}/spool
SlurmctldPidFile={top}/slurmctld.pid
SlurmdPidFile={top}/slurmd.pid
SlurmctldLogFile={top}/slurmctld.log
SlurmdLogFile={top}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
KillWait=2
MpiDefault=none
SwitchType=switch/none
JobAcctGatherType=jobacct_gather/none
SchedulerParameters=bf_interval=1
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def free_ports(count):
    taken = [socket.socket() for _ in range(count)]
    for one in taken:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in taken]
    for one in taken:
        one.close()
    return ports


class Cluster:
    """One node with two processors. Raises unittest.SkipTest where it does not start."""

    def __init__(self):
        missing = [name for name in NEEDED if not shutil.which(name, path=PATH)]
        if missing:
            raise unittest.SkipTest(f"no {', '.join(missing)} (Debian: slurm-wlm, munge)")
        if os.geteuid() != 0:
            raise unittest.SkipTest("only root starts a cluster of its own")
        self.top = tempfile.mkdtemp(prefix="roil-farm-")
        self.servers = []
        for name in "state", "spool":
            os.mkdir(os.path.join(self.top, name))
        with open(os.path.join(self.top, "key"), "wb") as key:
            os.fchmod(key.fileno(), 0o600)
            key.write(os.urandom(1024))
        conf = os.path.join(self.top, "slurm.conf")
        with open(conf, "w", encoding="utf-8") as file:
            file.write(CONF.format(host=socket.gethostname().split(".")[0], top=self.top, ports=free_ports(2)))
        self.environment = {**os.environ, "SLURM_CONF": conf, "PATH": PATH}
        self.serve("munged", "--foreground", "--force", "--socket=" + self.top + "/munge", "--key-file=" + self.top + "/key",
                   "--pid-file=" + self.top + "/munge.pid", "--log-file=" + self.top + "/munge.log",
                   "--seed-file=" + self.top + "/munge.seed")
        self.wait(lambda: os.path.exists(self.top + "/munge"), "munged")
        self.serve("slurmctld", "-D", "-c")
        self.serve("slurmd", "-D", "-c")
        self.wait(lambda: "idle" in self.ask("sinfo", "--noheader", "--format=%T"), "slurmctld and slurmd")

    def serve(self, *command):
        with open(os.path.join(self.top, command[0] + ".out"), "wb") as out:
            self.servers.append(subprocess.Popen(command, env=self.environment, stdin=subprocess.DEVNULL, stdout=out,
                                                 stderr=subprocess.STDOUT))

    def ask(self, *command):
        return subprocess.run(command, env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              check=False).stdout

    def wait(self, ready, what):
        end = time.monotonic() + 30
        while not ready():
            if time.monotonic() > end or any(server.poll() is not None for server in self.servers):
                self.stop()
                raise unittest.SkipTest(f"{what} cannot start here")
            time.sleep(0.05)  # nothing tells when

    def stop(self):
        for server in reversed(self.servers):
            server.terminate()
            try:
                server.wait(20)
            except subprocess.TimeoutExpired:
                server.kill()
                server.wait()
        shutil.rmtree(self.top, ignore_errors=True)


class Farm(Case):
    @classmethod
    def setUpClass(cls):
        cls.cluster = Cluster()
        cls.addClassCleanup(cls.cluster.stop)

    def farm(self, *arguments, program=PROGRAM):
        environment = {**self.cluster.environment, "ROIL": program, "REAL": PROGRAM}
        return subprocess.Popen([FARM, *arguments], cwd=self.folder, env=environment, stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def pictures(self, folder):
        return {name: self.read(f"{folder}/{name}") for name in sorted(os.listdir(self.path(folder))) if name.endswith(".png")}

    def test_a_simulation_in_parts_of_which_one_is_killed(self):
        self.write("air.lua", AIR.replace("frames = 12", "frames = 64"))
        self.succeeds("render", "air.lua", "-o", "whole/%02d.png", *SIZE)
        self.write("stopped.sh", STOPPED)
        os.chmod(self.path("stopped.sh"), 0o755)
        followed = self.farm("simulation", "air.lua", "-o", "parts/%02d.png", "--frames", "1-64", "--shards", "4", "--every",
                             "16", "--", *SIZE, program="stopped.sh")
        end = time.monotonic() + 200
        while not os.path.exists(self.path("parts/stopped")):
            self.assertTrue(time.monotonic() < end and followed.poll() is None, "the second part was never at work")
            time.sleep(0.05)
        self.assertTrue(os.path.exists(self.path("parts/17.png")))
        self.assertFalse(os.path.exists(self.path("parts/32.png")))
        running = self.cluster.ask("squeue", "--noheader", "--array", "--states=RUNNING", "--format=%i %j").split("\n")
        job = next(line.split()[0] for line in running if "_2 " in line)
        self.assertEqual(self.cluster.ask("scancel", job), "")
        self.requeue(job)
        said = followed.communicate(timeout=200)[0]
        self.assertEqual(followed.returncode, 0, said)
        self.assertIn("farm: 5 of 5 tasks done, 0 running; 64 pictures", said)
        self.assertEqual(self.pictures("parts"), self.pictures("whole"))
        with open(self.path(os.path.join("parts", "farm", "frames-2.log")), encoding="utf-8") as log:
            text = log.read()
        self.assertIn("CANCELLED", text)
        self.assertIn("frames were there", text.split("CANCELLED")[1])

        before = os.stat(self.path("parts/20.png")).st_mtime_ns
        os.remove(self.path("parts/40.png"))
        again = self.farm("frames", "air.lua", "-o", "parts/%02d.png", "--frames", "1-64", "--shards", "2", "--", *SIZE)
        self.assertIn("farm: done", again.communicate(timeout=200)[0])
        self.assertEqual(self.pictures("parts"), self.pictures("whole"))
        self.assertEqual(os.stat(self.path("parts/20.png")).st_mtime_ns, before)

    def requeue(self, job):
        """Slurm takes a job back once it has ended, and lets it wait for two minutes unless told otherwise."""
        end = time.monotonic() + 60
        while self.cluster.ask("scontrol", "requeue", job) and time.monotonic() < end:
            time.sleep(0.05)
        waits = ("JobState=COMPLETING", "JobState=PENDING")
        while any(state in self.cluster.ask("scontrol", "show", "job", job) for state in waits) and time.monotonic() < end:
            self.cluster.ask("scontrol", "update", "jobid=" + job, "starttime=now")
            time.sleep(0.2)

    def test_a_sweep_in_parts(self):
        self.write("ball.lua", """
local fx = effect { name = "ball" }
fx.camera = orbit { target = {0, 0, 0}, distance = 6 }
local radius = param { "radius", 1, min = 0.1, max = 2 }
fx.output = final { march { density = sphere { radius = radius } * 4, steps = 8 } }.color
return fx
""")
        self.write("sweep.lua", """
return sweep { name = "ball", effect = "ball.lua", size = {32, 18}, frames = "1", settle = 0, warmup = 0, repeats = 1,
  axes = { axis { "march.steps", 4, 8, 12, 16, 20, 24, 28, 32 }, axis { "radius", 0.5, 1, 1.5 } } }
""")
        followed = self.farm("sweep", "sweep.lua", "-o", "out", "--shards", "3", "--", "--limit", "60")
        said = followed.communicate(timeout=200)[0]
        self.assertEqual(followed.returncode, 0, said)
        rows = list(csv.DictReader(io.StringIO(self.read("out/results.csv").decode())))
        self.assertEqual([int(row["index"]) for row in rows], list(range(24)))
        self.assertEqual({row["state"] for row in rows}, {"done"})
        self.assertEqual({row["device"] for row in rows}, {""})

    def test_what_fails_is_said(self):
        self.write("bad.lua", "local fx = effct {}\n")
        followed = self.farm("frames", "bad.lua", "-o", "bad/%02d.png", "--frames", "1-4", "--shards", "2")
        said = followed.communicate(timeout=100)[0]
        self.assertEqual(followed.returncode, 1)
        self.assertIn("unknown name 'effct'; did you mean 'effect'?", said)
        self.assertIn("2 of 2 tasks are not done; the same command goes on", said)


class Usage(Case):
    def test_mistakes(self):
        self.write("a.lua", "")
        for status, says, *arguments in (
                (2, "frames, simulation or sweep"), (2, "'film' is none of", "film"), (2, "of which file?", "frames"),
                (1, "none.lua: no such file", "frames", "none.lua"), (2, "-o is missing", "frames", "a.lua"),
                (2, "--shards ''", "frames", "a.lua", "-o", "x%d.png"), (2, "unknown option '--set'", "frames", "a.lua", "--set"),
                (2, "-o wants a value", "frames", "a.lua", "-o"),
                (2, "--frames is missing", "frames", "a.lua", "-o", "x%d.png", "--shards", "2"),
                (2, "accepted: pictures with a number", "frames", "a.lua", "-o", "x.mp4", "--shards", "2"),
                (2, "--every ''", "simulation", "a.lua", "-o", "x%d.png", "--shards", "2", "--frames", "1-2"),
                (2, "a sweep has a folder", "sweep", "a.lua", "-o", "x%d.png", "--shards", "2")):
            done = subprocess.run([FARM, *arguments], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                  check=False)
            self.assertEqual(done.returncode, status, done.stderr)
            self.assertTrue(done.stderr.startswith("farm: ") and says in done.stderr, done.stderr)
        self.assertIn("--sbatch", subprocess.run([FARM, "--help"], stdout=subprocess.PIPE, text=True, check=True).stdout)


if __name__ == "__main__":
    main()
