"""The standard's registers as hilcam answers them (io/gige/device/gige_bootstrap.cpp): formulas look at them."""

CAPABILITY = sum(1 << bit for bit in (31, 30, 29, 27, 22, 21, 20, 19, 18, 17, 6, 5, 4, 3, 2, 1, 0))
NUMBERS = {
    0x0000: 0x00020000, 0x0004: 0x80000001, 0x0010: 5, 0x0014: 4, 0x0600: 1, 0x0900: 1, 0x0904: 1, 0x0908: 1, 0x0910: 1,
    0x092C: 0xC0000000, 0x0930: 0x80000000, 0x0934: CAPABILITY, 0x0938: 3000, 0x093C: 0, 0x0940: 1000000000, 0x0950: 0,
    0x0954: 0, 0x0958: 60000, 0x0960: 0, 0x0964: 1, 0x0968: 0, 0x0970: 16, 0x0A00: 2, 0x0A04: 0, 0x0B00: 0, 0x0B10: 0,
    0x0B14: 0, 0x0B18: 0, 0x0B1C: 0, 0x0D00: 0, 0x0D04: 1500, 0x0D08: 0, 0x0D18: 0, 0x0D1C: 0, 0x0D20: 0x0A000000, 0x0D24: 0,
    0x0008: 0x0200, 0x000C: 1, 0x0024: 0x7F000001, 0x0034: 0xFF000000, 0x0044: 0, 0x064C: 0, 0x065C: 0, 0x066C: 0, 0x0670: 0,
    0x096C: 0, 0x0948: 0, 0x094C: 0, 0x0944: 0, 0x095C: 0, 0x0A14: 0, 0x090C: 0, 0x9800: 0, 0x9804: 0,
}
TEXTS = {0x0048: 32, 0x0068: 32, 0x0088: 32, 0x00A8: 48, 0x00D8: 16, 0x00E8: 16, 0x0200: 512, 0x0400: 512}


def put(memory, texts):
    """Writes them, and returns the bits that they cover. texts: by address."""
    held = set()
    for address, number in NUMBERS.items():
        memory.write(address, number.to_bytes(4, "big"))
        held |= set(range(8 * address, 8 * (address + 4)))
    for address, length in TEXTS.items():
        memory.write(address, texts.get(address, "").encode()[:length - 1].ljust(length, b"\0"))
        held |= set(range(8 * address, 8 * (address + length)))
    return held
