"""Language models behind one small seam: see `seam`."""
