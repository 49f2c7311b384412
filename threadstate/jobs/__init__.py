"""The queue of jobs: requested libraries, the workers that compute them, and their events. Nothing here computes."""
