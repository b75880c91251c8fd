"""Writes the files that hfields.xml names: pictures of every kind of colour, and a mesh and heights under other endings."""

import pathlib
import struct
import zlib

HERE = pathlib.Path(__file__).parent


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def picture(name, width, height, color, depth, rows, palette=b""):
    head = chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, depth, color, 0, 0, 0))
    body = chunk(b"IDAT", zlib.compress(b"".join(b"\0" + bytes(row) for row in rows)))
    (HERE / name).write_bytes(b"\x89PNG\r\n\x1a\n" + head + palette + body + chunk(b"IEND", b""))


picture("grey.png", 3, 2, 0, 8, [[0, 50, 100], [150, 200, 250]])
picture("grey_alpha.png", 3, 2, 4, 8, [[0, 255, 50, 0, 100, 9], [150, 9, 200, 8, 250, 7]])
picture("color.png", 3, 2, 2, 8, [[0, 90, 20, 50, 0, 70, 100, 110, 0], [150, 1, 2, 200, 3, 4, 250, 255, 255]])
picture("color_alpha.png", 2, 2, 6, 8, [[0, 10, 20, 255, 50, 60, 70, 0], [150, 1, 2, 9, 200, 3, 4, 9]])
picture("bits.png", 3, 2, 0, 1, [[0b01000000], [0b11100000]])
picture("four_bits.png", 3, 2, 0, 4, [[0x12, 0x30], [0x4F, 0x60]])
picture("deep.png", 3, 2, 0, 16, [struct.pack(">3H", 0, 500, 10000), struct.pack(">3H", 20000, 40000, 65535)])
palette = chunk(b"PLTE", bytes([0, 0, 0, 255, 0, 0, 0, 255, 0, 10, 20, 30]))
picture("palette.png", 2, 2, 3, 2, [[0b00010000], [0b10110000]], palette)
picture("picture.dat", 3, 2, 0, 8, [[7, 7, 9], [0, 1, 2]])
(HERE / "heights.png.bin").write_bytes(struct.pack("<2i6f", 2, 3, 0, 1, 2, 3, 4, 5))
corners, faces = [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1.5], [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]
(HERE / "tetrahedron.dat").write_bytes(struct.pack("<4i12f12i", 4, 0, 0, 4, *corners, *faces))
