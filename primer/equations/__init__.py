"""What an equation is: from text to a tree, and from the tree to its linearisation with numbers for its names."""
