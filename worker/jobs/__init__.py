"""The worker of jobs: takes chunks, computes them, hands them in, and watches the others."""
