"""States of whole libraries as the JSON that is sent, in a file beside the database: made once, then read in place."""
