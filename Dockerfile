FROM python:3.11-slim-bookworm AS build
ENV PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_NO_CACHE_DIR=1
WORKDIR /source
COPY requirements.lock requirements-node.lock package.json package-lock.json .npmrc ./
RUN python -m venv /opt/threadstate \
    && /opt/threadstate/bin/pip install --quiet --require-hashes --only-binary :all: -r requirements.lock \
    && pip install --quiet --require-hashes --only-binary :all: -r requirements-node.lock \
    && npm ci --omit=dev --ignore-scripts
COPY pyproject.toml hatch_build.py README.md ./
COPY threadstate threadstate
COPY worker worker
COPY service service
COPY migrations migrations
RUN /opt/threadstate/bin/pip install --quiet --no-deps --no-build-isolation --no-index .

FROM python:3.11-slim-bookworm
COPY --from=build /opt/threadstate /opt/threadstate
RUN install --directory --owner=1000 --group=1000 /data
USER 1000:1000
# Compiled kernels live beside the database: the file system itself may be read-only.
ENV PATH=/opt/threadstate/bin:$PATH \
    PYTHONUNBUFFERED=1 \
    THREADSTATE_DATA_DIR=/data \
    THREADSTATE_NUMBA_CACHE_DIR=/data/numba \
    THREADSTATE_HOST=0.0.0.0
VOLUME /data
EXPOSE 8000
CMD ["threadstate", "run"]
