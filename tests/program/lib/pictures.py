"""Just enough of PNG and OpenEXR to look into the program's pictures; and PNG to make some."""
import struct
import zlib

# ---- PNG (ISO 15948) --------------------------------------------------------------------------


def packed_pixels(data):
    """What of a PNG file is its picture, and not what it says of itself: the same for equal pixels."""
    packed, at = b"", 8
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    return packed


class Png:
    """`rows` of bytes or 16-bit numbers, `channels` a pixel."""

    def __init__(self, data):
        if data[:8] != b"\x89PNG\r\n\x1a\n":
            raise ValueError("not a PNG file")
        packed, at = b"", 8
        while at < len(data):
            length, kind = struct.unpack(">I4s", data[at:at + 8])
            body = data[at + 8:at + 8 + length]
            if kind == b"IHDR":
                self.width, self.height, self.bits, color, *rest = struct.unpack(">IIBBBBB", body)
                if rest != [0, 0, 0]:
                    raise ValueError("interlaced or unknown")
            elif kind == b"IDAT":
                packed += body
            at += 12 + length
        self.channels = {2: 3, 6: 4}[color]
        lines = self._unfilter(zlib.decompress(packed))
        count = self.width * self.channels
        self.rows = [struct.unpack(f">{count}{'H' if self.bits == 16 else 'B'}", line)
                     for line in lines]

    def _unfilter(self, data):
        pixel = self.channels * self.bits // 8
        size = self.width * pixel
        before, lines = bytearray(size), []
        for y in range(self.height):
            kind, *line = data[y * (size + 1):(y + 1) * (size + 1)]
            line = bytearray(line)
            for i in range(size):
                left = line[i - pixel] if i >= pixel else 0
                up, corner = before[i], before[i - pixel] if i >= pixel else 0
                line[i] = line[i] + (0, left, up, (left + up) // 2,
                                     self._paeth(left, up, corner))[kind] & 255
            lines.append(line)
            before = line
        return lines

    @staticmethod
    def _paeth(left, up, corner):
        guess = left + up - corner
        return min((left, up, corner), key=lambda value: abs(guess - value))

    def channel(self, c):
        return [value for row in self.rows for value in row[c::self.channels]]


def write_png(path, width, height, color):
    """`color(x, y)` gives (red, green, blue)."""
    lines = b"".join(b"\0" + bytes(v for x in range(width) for v in color(x, y))
                     for y in range(height))

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    with open(path, "wb") as f:
        f.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
                + chunk(b"IDAT", zlib.compress(lines)) + chunk(b"IEND", b""))


# ---- OpenEXR (single-part scanline files, ZIP of 16 lines) ------------------------------------

ZIP, BLOCK_LINES = 3, 16
TYPES = {1: "e", 2: "f"}  # half, float


def exr_header(width, height, channels):
    """A file of halves that ends where its pixels would begin."""
    def attribute(name, kind, body):
        return name + b"\0" + kind + b"\0" + struct.pack("<I", len(body)) + body
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    listed = b"".join(c.encode() + b"\0" + struct.pack("<i4x2i", 1, 1, 1) for c in sorted(channels)) + b"\0"
    return struct.pack("<II", 20000630, 2) + b"".join([
        attribute(b"channels", b"chlist", listed), attribute(b"compression", b"compression", bytes([ZIP])),
        attribute(b"dataWindow", b"box2i", window), attribute(b"displayWindow", b"box2i", window),
        attribute(b"lineOrder", b"lineOrder", b"\0"), attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1)),
        attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0)),
        attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1))]) + b"\0"


class Exr:
    """`channels`: a list of values by name; `types`: 1 half, 2 float."""

    def __init__(self, data):
        if struct.unpack("<I", data[:4])[0] != 20000630:
            raise ValueError("not an OpenEXR file")
        self.data, self.at = data, 8
        attributes = {}
        while (name := self._text()) != "":
            self._text()  # its type
            size = struct.unpack("<I", self._bytes(4))[0]
            attributes[name] = self._bytes(size)
        box = struct.unpack("<4i", attributes["dataWindow"])
        self.width, self.height = box[2] - box[0] + 1, box[3] - box[1] + 1
        self.compression = attributes["compression"][0]
        self.types = self._channel_types(attributes["channels"])
        self.channels = {name: [] for name in self.types}
        if self.compression != ZIP:
            raise ValueError("not compressed as ZIP")
        for _ in range((self.height + BLOCK_LINES - 1) // BLOCK_LINES):
            self._bytes(8)  # table of offsets; blocks follow in order
        for y in range(0, self.height, BLOCK_LINES):
            self._block(min(BLOCK_LINES, self.height - y))

    def _bytes(self, count):
        self.at += count
        return self.data[self.at - count:self.at]

    def _text(self):
        end = self.data.index(b"\0", self.at)
        return self._bytes(end + 1 - self.at)[:-1].decode()

    @staticmethod
    def _channel_types(body):
        types, at = {}, 0
        while body[at]:
            end = body.index(b"\0", at)
            types[body[at:end].decode()] = struct.unpack("<i", body[end + 1:end + 5])[0]
            at = end + 17
        return types

    def _block(self, lines):
        packed = self._bytes(struct.unpack("<ii", self._bytes(8))[1])
        size = lines * self.width * sum(struct.calcsize(TYPES[t]) for t in self.types.values())
        raw = packed if len(packed) == size else self._unzip(packed)
        at = 0
        for _ in range(lines):
            for name, kind in self.types.items():
                form = f"<{self.width}{TYPES[kind]}"
                self.channels[name] += struct.unpack_from(form, raw, at)
                at += struct.calcsize(form)

    @staticmethod
    def _unzip(packed):
        data = bytearray(zlib.decompress(packed))
        for i in range(1, len(data)):
            data[i] = data[i - 1] + data[i] - 128 & 255
        half = (len(data) + 1) // 2
        raw = bytearray(len(data))
        raw[0::2], raw[1::2] = data[:half], data[half:]
        return bytes(raw)
