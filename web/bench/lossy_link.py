#!/usr/bin/env python3
"""A network link with delay and loss between this machine and a network namespace: packets pass a process that holds
each for some time and drops some, as `tc netem` does where the kernel has it. Needs root and /dev/net/tun.

    lossy_link.py NAMESPACE --delay-ms 50 --loss 0.01 [--seed 1]

This machine is 10.99.0.1, the namespace 10.99.0.2. Prints "ready", and ends with its standard input.
"""

import argparse
import collections
import fcntl
import os
import random
import select
import struct
import subprocess
import sys
import time

SET_INTERFACE = 0x400454CA  # TUNSETIFF of <linux/if_tun.h>
PACKETS_ONLY = 0x1001  # IFF_TUN | IFF_NO_PI
LONGEST = 65535  # [bytes] of an IP packet.


def run(*command):
    subprocess.run(command, check=True)


def open_end(name):
    end = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
    fcntl.ioctl(end, SET_INTERFACE, struct.pack("16sH", name.encode(), PACKETS_ONLY))
    return end


def set_up(namespace):
    """Makes both ends, one of them in the namespace."""
    near, far = open_end("hvas-near"), open_end("hvas-far")
    run("ip", "netns", "add", namespace)
    run("ip", "link", "set", "hvas-far", "netns", namespace)
    run("ip", "addr", "add", "10.99.0.1/24", "dev", "hvas-near")
    run("ip", "link", "set", "hvas-near", "up")
    run("ip", "-n", namespace, "addr", "add", "10.99.0.2/24", "dev", "hvas-far")
    run("ip", "-n", namespace, "link", "set", "hvas-far", "up")
    run("ip", "-n", namespace, "link", "set", "lo", "up")
    return near, far


def forward(near, far, delay, loss, rng):
    """Until the standard input ends. Packets of one way keep their order."""
    other = {near: far, far: near}
    waiting = {near: collections.deque(), far: collections.deque()}  # By the end that gets them: (time, packet).
    while True:
        due = min((queue[0][0] for queue in waiting.values() if queue), default=None)
        patience = None if due is None else max(0.0, due - time.monotonic())
        readable, _, _ = select.select([near, far, sys.stdin], [], [], patience)
        if sys.stdin in readable and not os.read(sys.stdin.fileno(), 1):
            return
        for end in (near, far):
            if end in readable:
                packet = os.read(end, LONGEST)
                if rng.random() >= loss:
                    waiting[other[end]].append((time.monotonic() + delay, packet))
        for end, queue in waiting.items():
            while queue and queue[0][0] <= time.monotonic():
                os.write(end, queue.popleft()[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("namespace")
    parser.add_argument("--delay-ms", type=float, default=50, help="of each way [ms]")
    parser.add_argument("--loss", type=float, default=0.01, help="share of packets that are dropped, of each way")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    near, far = set_up(options.namespace)
    try:
        print("ready", flush=True)
        forward(near, far, options.delay_ms / 1000, options.loss, random.Random(options.seed))
    finally:
        run("ip", "netns", "del", options.namespace)


if __name__ == "__main__":
    main()
