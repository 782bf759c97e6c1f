"""The test for ill-posedness: linearise, freeze, look for exponentials (section A2.1 of the paper)."""
