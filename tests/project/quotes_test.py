"""Every C++ block of a page is in the program that it is said to be from.

Arguments: page, program. Indentation and empty lines do not matter; order of lines does.
"""
import re
import sys


def lines(text):
    return [line.strip() for line in text.splitlines() if line.strip()]


page, program = (open(name).read() for name in sys.argv[1:3])
blocks = re.findall(r"^```cpp\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
assert blocks, f"{sys.argv[1]} has no C++ block"
compiled = lines(program)
missing = 0
for block in map(lines, blocks):
    starts = range(len(compiled) - len(block) + 1)
    if not any(compiled[i:i + len(block)] == block for i in starts):
        print(f"not in {sys.argv[2]}:", *block, sep="\n  ")
        missing += 1
print(f"{len(blocks) - missing} of {len(blocks)} blocks are in the program")
sys.exit(missing != 0)
