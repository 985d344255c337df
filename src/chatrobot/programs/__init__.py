"""Generated programs: extracted, checked, rehearsed, boxed in and kept."""
