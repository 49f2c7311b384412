// Without validatorUrl: null the page would ask a server elsewhere to validate the description.
SwaggerUIBundle({ url: "/openapi.json", dom_id: "#interface", deepLinking: true, validatorUrl: null });
