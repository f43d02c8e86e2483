#!/usr/bin/env python3
"""Runs `benchmark` or `label` on workers that Slurm starts:

    python3 slurm.py --jobs 20 --cores 16 --partition cpu -- label --dataset /shared/kitti --output /shared/labels

What follows -- is a command of `python3 -m lidar_panoptic_clustering`. Needs dask-jobqueue (pip), and this package and
the data set under the same path on all nodes. The jobs end with the command.
"""
import argparse
import subprocess
import sys

from dask_jobqueue import SLURMCluster


def main():
    """The command's exit status."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--jobs', type=int, default=1, help='Slurm jobs')
    parser.add_argument('--cores', type=int, default=16, help='of a job; a worker each')
    parser.add_argument('--memory', default='16GB', help='of a job; 0.3 GB a worker are enough for 64 x 2048 points')
    parser.add_argument('--partition', help='queue')
    parser.add_argument('--walltime', default='04:00:00')
    parser.add_argument('--interface', help='network interface of the nodes, e.g. ib0')
    parser.add_argument('command', nargs=argparse.REMAINDER)
    given = parser.parse_args()
    command = given.command[1:] if given.command[:1] == ['--'] else given.command

    cluster = SLURMCluster(cores=given.cores, processes=given.cores, memory=given.memory, queue=given.partition,
                           walltime=given.walltime, interface=given.interface)
    with cluster:
        cluster.scale(jobs=given.jobs)
        return subprocess.call([sys.executable, '-m', 'lidar_panoptic_clustering', *command,
                                '--scheduler', cluster.scheduler_address, '--wait', '3600'])


if __name__ == '__main__':
    sys.exit(main())
