// What a page of one's own needs to say for the package: that workers are modules.
export default { base: './', worker: { format: 'es' } };
