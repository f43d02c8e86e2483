#!/usr/bin/env python3
"""A network's labels -> instances -> picture, in one screen.

    python3 doc/example.py --picture objects.png
    python3 doc/example.py --dataset /data/semantickitti --semantics /data/my_network --sequence 08 --picture objects.png

Without a data set a simulated street takes the network's place. Needs matplotlib for the picture.
"""
import argparse

import matplotlib
import numpy as np

import lidar_panoptic_clustering as lpc

matplotlib.use('Agg')  # a file, no window
import matplotlib.pyplot as plt  # noqa: E402


def read_scan(arguments):
    """Points and the class of each, as a network has it."""
    if not arguments.dataset:
        points, labels, _ = lpc.LidarSimulator('hdl64e', seed=7).scan(arguments.scan)  # organised: (H, W, 4), (H, W)
        return points, labels
    kitti = lpc.SemanticKitti(arguments.dataset, semantics=arguments.semantics)
    scan = kitti.scans(arguments.sequence)[arguments.scan]
    return kitti.points(arguments.sequence, scan), kitti.classes(arguments.sequence, scan)


def corners(box):
    """The outline of a box in bird's-eye view, closed: (5, 2)"""
    half = 0.5 * np.array([[1, 1], [1, -1], [-1, -1], [-1, 1], [1, 1]]) * [box['length'], box['width']]
    c, s = np.cos(box['yaw']), np.sin(box['yaw'])
    return half @ np.array([[c, s], [-s, c]]) + [box['x'], box['y']]


def draw(points, instances, objects, names, path):
    x, y, instance = points[..., 0].ravel(), points[..., 1].ravel(), instances.ravel()
    figure, axes = plt.subplots(figsize=(10, 10))
    stuff = instance == 0
    axes.scatter(x[stuff], y[stuff], s=0.2, c='0.75', linewidths=0)
    color = plt.get_cmap('tab20')(instance[~stuff] % 20)
    axes.scatter(x[~stuff], y[~stuff], s=2, c=color, linewidths=0)
    for one in objects:
        outline = corners(one['box'])
        axes.plot(*outline.T, color='black', linewidth=0.8)
        axes.annotate(f"{names[one['class']]} {one['id']}", outline.max(axis=0), fontsize=7, clip_on=True)
    axes.set(xlim=(-40, 40), ylim=(-40, 40), aspect='equal', xlabel='x, ahead [m]', ylabel='y, left [m]',
             title=f'{len(objects)} objects')
    figure.savefig(path, dpi=120, bbox_inches='tight')


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--dataset', default='', help='folder that holds sequences/; otherwise a street is simulated')
    parser.add_argument('--semantics', default='', help="folder of a network's predictions; otherwise the true classes")
    parser.add_argument('--sequence', default='08')
    parser.add_argument('--scan', type=int, default=0, help='its place in the sequence')
    parser.add_argument('--algorithm', default='birds_eye', choices=lpc.algorithms())
    parser.add_argument('--picture', default='objects.png')
    arguments = parser.parse_args()

    points, labels = read_scan(arguments)
    segmenter = lpc.Segmenter(arguments.algorithm, class_table='semantic_kitti')
    instances = segmenter(points, labels)

    names = {ids[0]: name for name, ids in lpc.class_ids('semantic_kitti').items()}
    for one in segmenter.objects:
        box = one['box']
        print(f"{one['id']:3} {names[one['class']]:14} {one['points']:6} points  at {box['x']:6.1f} {box['y']:6.1f} m  "
              f"{box['length']:.1f} x {box['width']:.1f} x {box['height']:.1f} m")
    draw(points, instances, segmenter.objects, names, arguments.picture)
    print(f'{len(segmenter.objects)} objects; picture: {arguments.picture}')


if __name__ == '__main__':
    main()
