"""What is solved: the equations of the paper's Appendix 2, each written once."""
