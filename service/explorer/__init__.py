"""The explorer: a page for people who look before they read."""
