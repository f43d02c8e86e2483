"""Loaded by every python started with this folder in PYTHONPATH: localhost is 127.0.0.1, whatever the system knows."""
import socket

_getaddrinfo = socket.getaddrinfo


def _getaddrinfo_with_localhost(host, *args, **kwargs):
    return _getaddrinfo('127.0.0.1' if host == 'localhost' else host, *args, **kwargs)


socket.getaddrinfo = _getaddrinfo_with_localhost
