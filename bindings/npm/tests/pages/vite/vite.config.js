// The only setting that a project needs for the package: workers are modules.
export default { base: './', worker: { format: 'es' } };
