"""The worker of jobs: leases chunks, computes and completes them, and detects dead workers."""
