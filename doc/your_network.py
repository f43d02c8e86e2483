#!/usr/bin/env python3
"""A semantic network in the loop of sensor.launch: takes scans, answers with class ids under the same header.

  labels:=image   ~input is the organizer's NAME/unlabelled; ~labels an image of that size
  labels:=cloud   ~input is the driver's own cloud, _as_cloud:=true; ~labels its points in the same order
"""
import numpy as np
import rospy
from sensor_msgs.msg import Image, PointCloud2, PointField

TYPES = ['', 'i1', 'u1', 'i2', 'u2', 'i4', 'u4', 'f4', 'f8']  # by PointField's codes


def infer(scan):
    """Here goes the network: fields by name, (rows, columns) each, in; ids of SemanticKITTI out."""
    x, y, z = (scan[name].astype('f4') for name in 'xyz')
    near = np.hypot(x, y) < 20  # false for NaN, which is no return
    height = z - (np.percentile(z[near], 10) if near.any() else 0)
    labels = np.where(height < 0.3, 40, np.where(height < 2.2, 10, 70))  # road, car, vegetation
    return np.where(np.isfinite(z), labels, 0).astype('u1')


def receive(cloud):
    names, types, offsets = zip(*((f.name, '<' + TYPES[f.datatype], f.offset) for f in cloud.fields))
    point = np.dtype(dict(names=names, formats=types, offsets=offsets, itemsize=cloud.point_step))
    labels = infer(np.frombuffer(cloud.data, point).reshape(cloud.height, cloud.width))
    rospy.sleep(rospy.get_param('~delay_s', 0.06))  # a network's time
    shape = dict(header=cloud.header, height=cloud.height, width=cloud.width, data=labels.tobytes())
    if rospy.get_param('~as_cloud', False):
        field = PointField(name='label', offset=0, datatype=PointField.UINT8, count=1)
        output.publish(PointCloud2(fields=[field], point_step=1, row_step=cloud.width, **shape))
    else:
        output.publish(Image(encoding='8UC1', step=cloud.width, **shape))


rospy.init_node('your_network')
kind = PointCloud2 if rospy.get_param('~as_cloud', False) else Image
output = rospy.Publisher('~labels', kind, queue_size=2)
rospy.Subscriber('~input', PointCloud2, receive, queue_size=1, buff_size=1 << 26)
rospy.spin()
