"""What tests, scripts and benchmarks run against: databases, a PostgreSQL server, the service, a browser."""
