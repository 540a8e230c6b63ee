# SPDX-License-Identifier: Apache-2.0
"""A real Slurm of one node on this machine, in a folder of its own: munged, slurmctld and slurmd on free ports."""

from __future__ import annotations

import getpass
import os
import secrets
import signal
import socket
import subprocess
import time
from pathlib import Path

START_SECONDS = 60


class CannotStart(Exception):
    """A daemon is missing or stopped at once; the message has the end of its log."""


def _free_port() -> int:
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


class SingleNodeSlurm:
    """Context manager of a Slurm; its `environment` connects Slurm's programs to it."""

    def __init__(self, folder: Path, processors: int) -> None:
        self._folder = folder
        self._processors = processors
        self._daemons: list[subprocess.Popen] = []
        self.environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf"),
                            "PATH": f"{os.environ.get('PATH', '')}:/usr/sbin"}  # where Debian has the daemons

    def __enter__(self) -> SingleNodeSlurm:
        self._configure()
        folder = self._folder
        try:
            # --force: the folder may be one that others can enter.
            self._start("munged", "--foreground", "--force", f"--socket={folder}/munge.socket", f"--key-file={folder}/munge.key",
                        f"--pid-file={folder}/munged.pid", f"--log-file={folder}/munged.log",
                        f"--seed-file={folder}/munge.seed")
            self._wait("munged", lambda: (folder / "munge.socket").exists())
            self._start("slurmctld", "-D", "-c")
            self._start("slurmd", "-D", "-N", "node")
            self._wait("slurmd", lambda: "idle" in self.output("sinfo", "--noheader", "--format=%T"))
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        if len(self._daemons) > 1:
            self.output("scancel", "--user", getpass.getuser())
        for daemon in reversed(self._daemons):
            daemon.send_signal(signal.SIGTERM)
            try:
                daemon.wait(timeout=10)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
        self._daemons.clear()

    def output(self, *command: str) -> str:
        """Output of one of Slurm's programs; empty if the program fails."""
        result = subprocess.run(command, env=self.environment, capture_output=True, text=True, check=False)
        return result.stdout if result.returncode == 0 else ""

    def _configure(self) -> None:
        folder, user = self._folder, getpass.getuser()
        for name in ("state", "spool"):
            (folder / name).mkdir()
        key = folder / "munge.key"
        key.touch(mode=0o600)
        key.write_bytes(secrets.token_bytes(128))
        (folder / "slurm.conf").write_text(f"""\
ClusterName=sweep
SlurmctldHost={socket.gethostname()}(127.0.0.1)
SlurmctldPort={_free_port()}
SlurmdPort={_free_port()}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
ReturnToService=2
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1
NodeName=node NodeAddr=127.0.0.1 CPUs={self._processors} State=UNKNOWN
PartitionName=main Nodes=node Default=YES MaxTime=INFINITE State=UP
""", encoding="utf-8")

    def _start(self, *command: str) -> None:
        with (self._folder / f"{command[0]}.out").open("w", encoding="utf-8") as log:
            try:
                self._daemons.append(subprocess.Popen(command, env=self.environment, stdout=log, stderr=log))
            except OSError as error:
                raise CannotStart(f"{command[0]}: {error.strerror}") from None

    def _wait(self, name: str, ready) -> None:
        end = time.monotonic() + START_SECONDS
        while not ready():
            dead = [daemon for daemon in self._daemons if daemon.poll() is not None]
            if dead or time.monotonic() > end:
                logs = "".join(path.read_text(encoding="utf-8", errors="replace")[-500:]
                               for path in (self._folder / f"{name}.out", self._folder / f"{name}.log") if path.is_file())
                raise CannotStart(f"{name} did not start: {logs}")
            time.sleep(0.2)
