"""How a problem is marched: grids, the paper's scheme, and better ones to judge it by."""
