#!/usr/bin/python3
"""A Modbus TCP server of other hands, with eight holding registers from 100 for each unit. Writes its port, and after every write what its registers hold.

    modbus_server.py PORT-FILE REGISTERS-FILE UNITS
"""
import json
import os
import socket
import sys

from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
from pymodbus.server import StartTcpServer

blocks = {}


def put(path, text):
    with open(path + ".new", "w") as f:
        f.write(text)
    os.rename(path + ".new", path)


class Block(ModbusSequentialDataBlock):
    def setValues(self, address, values):
        super().setValues(address, values)
        put(sys.argv[2], json.dumps({unit: block.values for unit, block in blocks.items()}))


def main():
    for unit in range(1, int(sys.argv[3]) + 1):
        blocks[unit] = Block(100, [0] * 8)
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    units = {unit: ModbusSlaveContext(hr=block, zero_mode=True) for unit, block in blocks.items()}
    put(sys.argv[1], str(port))
    StartTcpServer(context=ModbusServerContext(slaves=units, single=False), address=("127.0.0.1", port))


main()
