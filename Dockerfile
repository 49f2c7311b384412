# Two stages: what builds (node, pip, hatchling) stays behind, the image holds Python and one environment.
FROM python:3.11-slim-bookworm AS build
ENV PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_NO_CACHE_DIR=1
WORKDIR /source
COPY requirements-runtime.lock ./
RUN python -m venv --without-pip /opt/threadstate \
    && pip --python /opt/threadstate/bin/python install --quiet --require-hashes --only-binary :all: -r requirements-runtime.lock
COPY requirements-build.lock requirements-node.lock package.json package-lock.json .npmrc ./
RUN pip install --quiet --require-hashes --only-binary :all: -r requirements-build.lock -r requirements-node.lock \
    && npm ci --omit=dev --ignore-scripts
COPY pyproject.toml hatch_build.py README.md LICENSE ./
COPY threadstate threadstate
COPY worker worker
COPY service service
COPY migrations migrations
RUN pip wheel --quiet --no-deps --no-build-isolation --no-index --wheel-dir /wheels . \
    && pip --python /opt/threadstate/bin/python install --quiet --no-deps --no-index /wheels/*.whl \
    && find /opt/threadstate -type d -name tests -prune -exec rm -r {} +

FROM python:3.11-slim-bookworm
COPY --from=build /opt/threadstate /opt/threadstate
RUN install --directory --owner=1000 --group=1000 /data /kernels
USER 1000:1000
# Compiled kernels are the machine's, data is not: two volumes, and the file system itself may be read-only.
ENV PATH=/opt/threadstate/bin:$PATH \
    PYTHONUNBUFFERED=1 \
    PYTHONDONTWRITEBYTECODE=1 \
    THREADSTATE_DATA_DIR=/data \
    THREADSTATE_NUMBA_CACHE_DIR=/kernels \
    THREADSTATE_HOST=0.0.0.0
EXPOSE 8000
HEALTHCHECK --interval=10s --timeout=5s --start-period=10m \
    CMD ["python", "-c", "import urllib.request; urllib.request.urlopen('http://127.0.0.1:8000/readyz', timeout=4)"]
CMD ["threadstate", "run"]
