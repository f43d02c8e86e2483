#!/usr/bin/env python3
"""Says what is ahead in our lane, and when we would be there: ~objects is a tracker's list."""
import rospy
from lidar_panoptic_clustering.msg import ObjectArray

def look(scan):
    ahead = [o for o in scan.objects if 2 < o.pose.position.x < 60 and abs(o.pose.position.y) < 1.5]
    for o in sorted(ahead, key=lambda o: o.pose.position.x)[:1]:
        gap, closing = o.pose.position.x - o.size.x / 2, rospy.get_param('~own_mps', 8.0) - o.velocity.x
        rospy.loginfo('%s #%d %.1f m ahead, there in %.1f s', o.class_name, o.track_id, gap, gap / max(closing, 0.1))
rospy.init_node('objects_ahead')
rospy.Subscriber('~objects', ObjectArray, look, queue_size=1)
rospy.spin()
