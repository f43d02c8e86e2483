#!/usr/bin/env python3
"""What a call from Python costs beside the same work in C++, and what two threads gain.

    python3 benchmark/python_calls.py --program build/scan_way_benchmark --dataset DIR [--sequence 00] [--scans 10]

Times are CPU time of the calling thread, the least of the repetitions of each scan, C++ and Python in turn; the share is
of their sums over the scans. Threads are measured by the clock, with a segmenter each: 2 are to be 1.8 times as fast.
"""
import argparse
import subprocess
import threading
import time

import numpy as np

import lidar_panoptic_clustering as lpc


def program_times(arguments):
    """{algorithm: least milliseconds a scan}"""
    output = subprocess.run([arguments.program, arguments.dataset, arguments.sequence, str(arguments.scans),
                             str(arguments.repetitions)], check=True, stdout=subprocess.PIPE,
                            universal_newlines=True).stdout
    return {name: np.array(times, float) for name, *times in map(str.split, output.splitlines())}


def call_times(algorithm, scans, repetitions):
    segmenter = lpc.Segmenter(algorithm)
    least = np.full(len(scans), np.inf)
    for k in range(repetitions + 1):
        for i, (points, labels) in enumerate(scans):
            start = time.thread_time()
            segmenter(points, labels)
            if k > 0:
                least[i] = min(least[i], 1e3 * (time.thread_time() - start))
    return least


def gain_of_threads(algorithm, scans, repetitions, threads):
    """How many times as fast the same number of scans goes through; the best of some rounds."""
    segmenters = [lpc.Segmenter(algorithm) for _ in range(threads)]

    def work(segmenter):
        for points, labels in scans:
            segmenter(points, labels)

    def seconds(workers):
        start = time.perf_counter()
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
        return time.perf_counter() - start

    work(segmenters[0])
    one, all_of_them = [], []
    for _ in range(repetitions):
        one.append(seconds([threading.Thread(target=work, args=(segmenters[0],))]))
        all_of_them.append(seconds([threading.Thread(target=work, args=(s,)) for s in segmenters]))
    return threads * min(one) / min(all_of_them)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--program', required=True, help='scan_way_benchmark of the build')
    parser.add_argument('--dataset', required=True)
    parser.add_argument('--sequence', default='00')
    parser.add_argument('--scans', type=int, default=10)
    parser.add_argument('--repetitions', type=int, default=5)
    parser.add_argument('--rounds', type=int, default=3, help='of C++ and Python in turn')
    parser.add_argument('--threads', type=int, default=2)
    arguments = parser.parse_args()

    kitti = lpc.SemanticKitti(arguments.dataset)
    names = kitti.scans(arguments.sequence)[:arguments.scans]
    scans = [(kitti.points(arguments.sequence, n), kitti.labels(arguments.sequence, n)) for n in names]
    program, call = {}, {}
    for _ in range(arguments.rounds):
        for name, times in program_times(arguments).items():
            program[name] = np.minimum(program.get(name, np.inf), times)
            call[name] = np.minimum(call.get(name, np.inf), call_times(name, scans, arguments.repetitions))
    print(f'{len(scans)} scans of {np.mean([len(p) for p, _ in scans]):.0f} points; ms of CPU a scan, least of '
          f'{arguments.rounds * arguments.repetitions}')
    print(f'{"algorithm":15}{"C++":>9}{"call":>9}{"more":>8}{"threads":>9}')
    for name in program:
        more = call[name].sum() / program[name].sum() - 1
        gain = gain_of_threads(name, scans, arguments.repetitions, arguments.threads)
        print(f'{name:15}{program[name].mean():9.2f}{call[name].mean():9.2f}{more:8.1%}{gain:9.2f}')


if __name__ == '__main__':
    main()
