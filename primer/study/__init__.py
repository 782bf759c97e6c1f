"""Many runs, one question: the only place that loops over runs."""
