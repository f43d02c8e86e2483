"""Becomes roslaunch, on the ROS master given or on one of its own.

usage: launch.py FD HOST MASTER ARGUMENT...

Where MASTER is empty a port is taken for a master of its own. It stays bound for as long as roslaunch runs, so that
nobody else is given it, and it is not listened to, so that the master can: two started at once never meet.
The master's address goes to the file descriptor FD.
"""
import os
import socket
import sys


def main():
    address, host, master, arguments = int(sys.argv[1]), sys.argv[2], sys.argv[3], sys.argv[4:]
    if not master:
        holder = socket.socket()
        holder.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        holder.bind(('', 0))
        holder.set_inheritable(True)
        port = holder.getsockname()[1]
        master = f'http://{host}:{port}'
        arguments = ['-p', str(port)] + arguments
    os.environ['ROS_MASTER_URI'] = master
    os.write(address, (master + '\n').encode())
    os.close(address)
    os.execvp('roslaunch', ['roslaunch'] + arguments)


if __name__ == '__main__':
    main()
