"""Granular rheologies under the same test: Coulomb, mu(I), CSSM and CIDR (sections 2 to 4 of the paper)."""
