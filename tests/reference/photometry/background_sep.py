"""Background of a raw float32 image by sep: python3 background_sep.py image nx ny cell filter level rms (raw float32)."""
import sys

import numpy as np
import sep

image = np.fromfile(sys.argv[1], dtype=np.float32).reshape(int(sys.argv[3]), int(sys.argv[2]))
cell, side = int(sys.argv[4]), int(sys.argv[5])
background = sep.Background(image, bw=cell, bh=cell, fw=side, fh=side)
background.back(dtype=np.float32).tofile(sys.argv[6])
background.rms(dtype=np.float32).tofile(sys.argv[7])
