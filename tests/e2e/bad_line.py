#!/usr/bin/python3
"""A bad cable for socat: copies stdin to a serial port and the port to stdout, and flips a bit of some pieces on the way.

    socat PTY,link=/tmp/bad,rawer SYSTEM:'bad_line.py /tmp/good 0.05'
"""
import os
import random
import select
import sys
import termios
import tty


def main():
    port = os.open(sys.argv[1], os.O_RDWR | os.O_NOCTTY)
    tty.setraw(port, termios.TCSANOW)
    share = float(sys.argv[2])
    chance = random.Random(7)
    way = {0: port, port: 1}
    while True:
        for source in select.select(list(way), [], [])[0]:
            piece = bytearray(os.read(source, 512))
            if not piece:
                return
            if chance.random() < share:
                piece[chance.randrange(len(piece))] ^= 1 << chance.randrange(8)
            os.write(way[source], piece)


main()
